// Guards: burnish reads and bounds a file's header before any image library sees the file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/io/stored_colour.h"

namespace burnish {

// A file in memory, with its name in errors.
struct ImageBytes {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
    std::string label;

    Error error(const std::string& place, const std::string& reason) const { return {ExitCode::bad_input, label, place, reason}; }
};

constexpr int kMaxChannels = 1024; // in one file

// Location and order of a Radiance file's pixels. Scanlines run in one of eight ways; three flags put the top row
// first.
struct RadianceLayout {
    std::size_t pixels_at = 0;
    int scanlines = 0, scanline_pixels = 0;
    bool transpose = false; // scanlines are columns
    bool flip_x = false, flip_y = false;
};

// Decoding instructions for a guarded file.
struct ImageProbe {
    const char* format = ""; // OpenImageIO's name for the format
    int subimage = 0;        // first flat part in an OpenEXR file
    RadianceLayout radiance = {};
    StoredColour colour = {};
    bool cube_faces = false; // OpenEXR's envmap = cube
    // Bytes for the library to read in place of the file's own, unless empty.
    std::vector<std::uint8_t> replacement = {};
};

// Finds the format by the first bytes, never by the extension. Refuses files that cannot be sound images: sides above
// the limits, more pixels than the file's bytes can hold, missing end marks.
Result<ImageProbe> probe_image(const ImageBytes& file, const Limits& limits);

// Handles PNG for probe_image. Drops the chunks that do not affect the samples.
Result<ImageProbe> probe_png(const ImageBytes& file, const Limits& limits);

// Handles Radiance files for probe_image.
Result<ImageProbe> probe_radiance(const ImageBytes& file, const Limits& limits);

// Handles OpenEXR for probe_image, because the library allocates as the header asks.
Result<ImageProbe> probe_exr(const ImageBytes& file, const Limits& limits);

// Handles TIFF for probe_image. The directory may lie anywhere in the file.
Result<ImageProbe> probe_tiff(const ImageBytes& file, const Limits& limits);

// Returns an Error for a side below 1 or above the limit, or for too many pixels.
Status check_sides(const ImageBytes& file, std::int64_t width, std::int64_t height, const Limits& limits);

// Returns an Error where the pixels are out of all proportion to the file's bytes. `pixel_bytes` is the size of a
// decoded pixel. Expects checked sides.
Status check_proportion(const ImageBytes& file, std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bytes);

} // namespace burnish
