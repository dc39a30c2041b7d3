// Reading and writing image files.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// What is told of a picture that was read, besides its pixels.
struct PictureNotes {
    bool cube_faces = false;           // OpenEXR's envmap = cube: six faces, one below the other
    bool converted = false;            // its colours had other primaries than Rec.709
    std::vector<std::string> warnings; // one line each, without the file's name
};

// Reads PNG, JPEG, WebP, OpenEXR, Radiance RGBE, TIFF, PNM/PFM and BMP, told apart by their first bytes,
// whatever the extension. Sizes are checked against the limits before pixels are read. 8-bit files give u8,
// 16-bit files u16, float and half files f32. Deep files are refused; of a tiled or mipmapped file the top
// level is read; of a multi-part file the first flat part. The data window of OpenEXR is placed in the
// display window. Channels R,G,B(,A), Y,RY,BY(,A) or Y(,A) are picked by name; without them
// all of up to 4 channels, else the first 3, with a warning. Values are those that the file was made of: luminance and chroma become
// RGB, EXPOSURE and COLORCORR of Radiance files are divided out, and the scale of PFM files multiplies. Primaries are left alone: this is
// for directions, heights and other data, and for files of our own.
Result<Image> read_image(const std::string& path, const Limits& limits, PictureNotes* notes = nullptr);

// The same from memory; `label` names the image in errors (for instance "scene.glb: /images/3").
Result<Image> decode_image(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                           PictureNotes* notes = nullptr);

// The same of a picture of colours: those of float formats become linear Rec.709, by the file's chromaticities or PRIMARIES, white adapted
// by Bradford's method. Files that name Rec.709 or nothing keep their bits.
Result<Image> read_colours(const std::string& path, const Limits& limits, PictureNotes& notes);
Result<Image> decode_colours(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                             PictureNotes& notes);

// Writes .exr (linear Rec.709, 32-bit float, ZIP), .hdr, .pfm; or .png .jpg .tif from u8 pixels. Nothing
// volatile is stored (no date, host, program arguments). The file appears under its name only when it is
// complete: it is written to a temporary name in the same folder, then renamed. On failure no file is left
// and the Error has ExitCode::output_failed.
Status write_image(const std::string& path, const Image& image);

// OpenEXR of any channels, a name each, as write_image() writes it.
Status write_channels(const std::string& path, const Image& image, const std::vector<std::string>& names);

// The bytes of an OpenEXR file of half floats with mip levels, the first the largest, each half as wide and high as that before, rounded
// down, at least 1, to 1x1: f32 images of one number of channels. `path` names it in errors.
Result<std::vector<std::uint8_t>> encode_exr_levels(const std::string& path, const std::vector<Image>& levels);

// An 8-bit picture as the bytes of a PNG file, for pages that carry their pictures.
Result<std::string> encode_png(const Image& image);

// True where the extension of `path` names a format that stores floats (exr, hdr, pfm).
bool stores_floats(const std::string& path);

// True where it names a format that takes channels of any name (exr).
bool stores_channels(const std::string& path);

// Writes bytes to `path` atomically (temporary name, rename), as write_image does.
Status write_file(const std::string& path, const std::string& bytes);

} // namespace burnish
