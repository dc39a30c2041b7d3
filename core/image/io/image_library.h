// The library behind the formats that are not read or written here: OpenImageIO, in a module of its own. It
// brings some 250 shared libraries, which take longer to load than a small picture to render, so it is opened
// when the first picture needs it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/io/guard.h"

namespace burnish {

// What the library made of a file's header.
struct StoredHeader {
    int width = 0, height = 0, depth = 0;                        // of the data window; a depth above 1 is a volume
    int x = 0, y = 0;                                            // where the data window begins
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0; // the display window
    int channels = 0;
    std::vector<std::string> channel_names;
    PixelType type = PixelType::f32; // that holds the file's samples
    bool deep = false;
};

// Channels [first, end) of the data window, interleaved, in the header's type; `to` has room for them.
struct PixelRequest {
    int first = 0, end = 0;
    std::byte* to = nullptr;
};

// Called with the header before any pixel is read: where they go, or why the file is refused.
using PlacePixels = std::function<Result<PixelRequest>(const StoredHeader&)>;

// The functions of the module. They may throw what the library throws.
struct ImageLibrary {
    // Errors of a damaged file have ExitCode::bad_input; those of `place` are handed on.
    Status (*read)(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place);
    // The bytes of a file of `format`, the library's name: openexr or hdr of float pixels, jpeg of 8-bit
    // ones. `path` names it in errors, which have ExitCode::output_failed. channels: names; empty: those of the image's number.
    Result<std::vector<std::uint8_t>> (*encode)(const std::string& path, const Image& image, const char* format,
                                                const std::vector<std::string>& channels);
    // Of OpenEXR, half floats in tiles of 64: each image a mip level, half as wide and high as that before, rounded down, at least 1.
    Result<std::vector<std::uint8_t>> (*encode_levels)(const std::string& path, const std::vector<Image>& levels);
};

// The one symbol of the module: extern "C" const ImageLibrary* burnish_image_library().
constexpr const char* kImageLibrarySymbol = "burnish_image_library";

// Opens the module at the first call: beside the program, in ../lib/burnish from there, or, for programs that
// lie in the build tree, at that tree's root. An Error with ExitCode::unavailable where it cannot be opened;
// `file` is the picture that needs it. Never null.
Result<const ImageLibrary*> image_library(const std::string& file);

// The first line of a library message, without its full stop.
inline std::string first_line(const std::string& text)
{
    std::string line = text.substr(0, text.find_first_of("\r\n"));
    while (!line.empty() && (line.back() == ' ' || line.back() == '.'))
        line.pop_back();
    return line;
}

} // namespace burnish
