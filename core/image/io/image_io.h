// Reads and writes image files.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

class Jobs;

// Facts about an image beside its pixels.
struct PictureNotes {
    bool cube_faces = false;           // OpenEXR's envmap = cube: six faces, one below the other
    bool converted = false;            // the colours had other primaries than Rec.709
    std::vector<std::string> warnings; // one line each, without the file name
};

// Returns true if there is room for the bytes that one image takes while it is decoded. Where a second decoder takes over, it asks again,
// for all bytes.
using HasRoom = std::function<bool(std::uint64_t bytes)>;

// Reads PNG, JPEG, WebP, OpenEXR, Radiance RGBE, TIFF, PNM/PFM and BMP. The first bytes tell the format, whatever the
// extension. Checks sizes against the limits before reading pixels. 8-bit files give u8, 16-bit files u16, float and
// half files f32.
//
// Refuses deep files. Reads the top level of a tiled or mipmapped file, and the first flat part of a multi-part file.
// Places the OpenEXR data window in the display window. Picks channels R,G,B(,A), Y,RY,BY(,A) or Y(,A) by name. Without
// such names, takes all of up to 4 channels, else the first 3 with a warning.
//
// Returns original values: luminance and chroma become RGB, EXPOSURE and COLORCORR of Radiance files are divided out,
// and the scale of PFM files multiplies. Leaves primaries alone: for directions, heights and other data, and for
// burnish's own files.
// Fails without allocating pixels if `room` returns false.
Result<Image> read_image(const std::string& path, const Limits& limits, PictureNotes* notes = nullptr, const HasRoom& room = {});

// Decodes an image in memory like read_image(). `label` names the image in errors ("scene.glb: /images/3").
Result<Image> decode_image(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                           PictureNotes* notes = nullptr, const HasRoom& room = {});

// Reads a colour image. Float formats become linear Rec.709 by the file's chromaticities or PRIMARIES, with Bradford
// white adaptation. Files that name Rec.709 or nothing keep their bits.
Result<Image> read_colours(const std::string& path, const Limits& limits, PictureNotes& notes, const HasRoom& room = {});
Result<Image> decode_colours(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                             PictureNotes& notes, const HasRoom& room = {});

// Writes .exr (linear Rec.709, 32-bit float, ZIP), .hdr, .pfm; or .png .jpg .tif from u8 pixels. Stores nothing
// volatile (no date, host, or arguments). The file appears under its name only when complete. On failure leaves no
// file, and the Error has ExitCode::output_failed. jobs: threads that encode PNG; null: the calling thread alone.
Status write_image(const std::string& path, const Image& image, const Jobs* jobs = nullptr);

// Writes OpenEXR with any channels, one name for each, like write_image().
Status write_channels(const std::string& path, const Image& image, const std::vector<std::string>& names);

// Encodes an OpenEXR file with half-float mip levels. `levels` are f32 images with equal channel counts, the largest
// first, down to 1x1; each side is half the previous one, rounded down, at least 1. `path` names the file in errors.
Result<std::vector<std::uint8_t>> encode_exr_levels(const std::string& path, const std::vector<Image>& levels);

// Encodes an 8-bit image as PNG, for pages with embedded images. jobs: see write_image().
Result<std::string> encode_png(const Image& image, const Jobs* jobs = nullptr);

// Returns true where the extension of `path` names a float format (exr, hdr, pfm).
bool stores_floats(const std::string& path);

bool is_png(const std::string& path); // by the extension

// Returns true where the extension names a format with arbitrary channels (exr).
bool stores_channels(const std::string& path);

// Writes bytes to `path` atomically, like write_image().
Status write_file(const std::string& path, const std::string& bytes);

} // namespace burnish
