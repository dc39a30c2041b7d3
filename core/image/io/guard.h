// Guards: what a file's own header claims, read and bounded by us before any image library sees the file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/io/stored_colour.h"

namespace burnish {

// A file in memory, and the name it has in errors.
struct ImageBytes {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
    std::string label;

    Error error(const std::string& place, const std::string& reason) const { return {ExitCode::bad_input, label, place, reason}; }
};

constexpr int kMaxChannels = 1024; // of a file

// Where the pixels of a Radiance file lie. Its scanlines run in any of eight ways; three flags put them top row first.
struct RadianceLayout {
    std::size_t pixels_at = 0;
    int scanlines = 0, scanline_pixels = 0;
    bool transpose = false; // scanlines are columns
    bool flip_x = false, flip_y = false;
};

// How to decode a guarded file.
struct ImageProbe {
    const char* format = ""; // OpenImageIO's name of the format
    int subimage = 0;        // the first flat part of an OpenEXR file
    RadianceLayout radiance = {};
    StoredColour colour = {};
    bool cube_faces = false; // OpenEXR's envmap = cube
    // What the library reads instead of the file's own bytes, where that is not empty.
    std::vector<std::uint8_t> replacement = {};
};

// Finds the format by the first bytes, never by the extension, and refuses what cannot be a sound image:
// sides above the limits, more pixels than the file's bytes can hold, missing end marks.
Result<ImageProbe> probe_image(const ImageBytes& file, const Limits& limits);

// The part of it for PNG, which leaves out the chunks that do not decide the samples.
Result<ImageProbe> probe_png(const ImageBytes& file, const Limits& limits);

// The part of it for Radiance files.
Result<ImageProbe> probe_radiance(const ImageBytes& file, const Limits& limits);

// The part of it for OpenEXR, whose library allocates what the header asks for.
Result<ImageProbe> probe_exr(const ImageBytes& file, const Limits& limits);

// The part of it for TIFF, whose directory may lie anywhere.
Result<ImageProbe> probe_tiff(const ImageBytes& file, const Limits& limits);

// An Error where a side is below 1 or above the limit, or the pixels are too many.
Status check_sides(const ImageBytes& file, std::int64_t width, std::int64_t height, const Limits& limits);

// An Error where so many pixels are out of all proportion to the file's bytes; `pixel_bytes`: of a decoded one. The sides are checked.
Status check_proportion(const ImageBytes& file, std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bytes);

} // namespace burnish
