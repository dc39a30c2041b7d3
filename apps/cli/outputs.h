// Files that a command writes. They are looked at before the work starts, and each appears complete or not at
// all.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/image/colour.h"
#include "core/image/image.h"

namespace burnish {

// The extension is known, the folder exists and can be written to, and `path` is none of the `inputs`.
Status check_picture_path(const std::string& path, const std::vector<std::string>& inputs);

// The same for a file of any extension; "-" is standard output.
Status check_text_path(const std::string& option, const std::string& path, const std::vector<std::string>& inputs);

// Both for all that a command writes: `pictures`, then texts as {option, path}, of which empty paths are passed over. No file may be given
// twice.
Status check_outputs(const std::vector<std::string>& pictures, const std::vector<std::pair<std::string, std::string>>& texts,
                     const std::vector<std::string>& inputs);

// The folder is there and can be written to, or can be made.
Status check_folder_path(const std::string& folder);

// Made where it is not there; it can be written to.
Status make_output_folder(const std::string& folder);

// Two names of one file, whether or not it exists yet; pipes and devices aside.
bool same_file(const std::string& a, const std::string& b);

// What a display shows of linear pixels, exposed and tonemapped: 8 bits, with alpha that colours are not multiplied by.
// parts: of pixels that are not made of the mean of their samples.
Image shown_picture(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts = {},
                    Resolve resolve = Resolve::linear);

// Linear pixels to a float format, or exposed and tonemapped to an 8-bit one, by extension.
Status write_picture(const std::string& path, const Image& linear, Tonemap tonemap, float exposure_ev,
                     const std::vector<PixelPart>& parts = {}, Resolve resolve = Resolve::linear);

// To a file (atomically), to standard output ("-"), or into a device or pipe that exists already.
Status write_text(const std::string& path, const std::string& text);

} // namespace burnish
