// Interface to OpenImageIO, for formats that burnish does not read or write itself. OpenImageIO lies in its own module,
// opened for the first image that needs it. It brings some 250 shared libraries, which take longer to load than a small
// image to render.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/text.h"
#include "core/image/image.h"
#include "core/image/io/guard.h"
#include "core/image/io/image_stream.h"

namespace burnish {

// The library's reading of a file header.
struct StoredHeader {
    int width = 0, height = 0, depth = 0;                        // size of the data window; a depth above 1 is a volume
    int x = 0, y = 0;                                            // origin of the data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0; // the display window
    int channels = 0;
    std::vector<std::string> channel_names;
    PixelType type = PixelType::f32; // holds the file's samples
    bool deep = false;
};

// Request for channels [first, end) of the data window, interleaved, in the header's type. `to` has room for them.
struct PixelRequest {
    int first = 0, end = 0;
    std::byte* to = nullptr;
};

// Callback before any pixel is read. Returns a request for the pixels, or an Error that refuses the file.
using PlacePixels = std::function<Result<PixelRequest>(const StoredHeader&)>;

// Writes an OpenEXR file of floats by rows, as ImageStream.
class RowWriter {
  public:
    virtual ~RowWriter() = default;
    virtual Status add(const Image& rows) = 0;
    virtual Status finish() = 0;
};

// The module's functions. They may throw the library's exceptions.
struct ImageLibrary {
    // Reads pixels. Errors for damaged files have ExitCode::bad_input; errors from `place` pass through.
    Status (*read)(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place);
    // Encodes a file. `format` is the library's name: openexr or hdr for float pixels, jpeg for 8-bit pixels. `path`
    // names the file in errors, which have ExitCode::output_failed. `channels` holds names; empty selects the default
    // names for the channel count. A request to stop makes an error.
    Result<std::vector<std::uint8_t>> (*encode)(const std::string& path, const Image& image, const char* format,
                                                const std::vector<std::string>& channels, const std::stop_token& stop);
    // Encodes OpenEXR mip levels as half floats in 64-pixel tiles. Each side is half the previous level's, rounded
    // down, at least 1.
    Result<std::vector<std::uint8_t>> (*encode_levels)(const std::string& path, const std::vector<Image>& levels);
    // Begins an OpenEXR file at `place`. `path` names the file in errors, which have ExitCode::output_failed.
    Result<std::unique_ptr<RowWriter>> (*write_rows)(const std::string& path, const std::string& place, const StreamedPicture& picture);
};

// The module's one symbol: extern "C" const ImageLibrary* burnish_image_library().
constexpr const char* kImageLibrarySymbol = "burnish_image_library";

// Opens the module at the first call: beside the program, in ../lib/burnish from there, or, for programs in a build
// tree, at the tree's root. Never returns null. Returns an Error with ExitCode::unavailable where the
// module is missing, and ExitCode::bad_input where memory or threads are. `file` is the image that needs the module.
Result<const ImageLibrary*> image_library(const std::string& file);

} // namespace burnish
