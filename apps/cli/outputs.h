// Output files of a command. All paths are checked before the work starts, and each file appears complete or not at all.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/image/colour.h"
#include "core/image/image.h"

namespace burnish {

// Checks that the extension is known, the folder exists and is writable, and `path` is none of the `inputs`.
Status check_picture_path(const std::string& path, const std::vector<std::string>& inputs);

// Checks a path with any extension; "-" is standard output.
Status check_text_path(const std::string& option, const std::string& path, const std::vector<std::string>& inputs);

// Checks all outputs of a command: `pictures`, then texts as {option, path}. Skips empty paths. Fails if two paths name one file.
Status check_outputs(const std::vector<std::string>& pictures, const std::vector<std::pair<std::string, std::string>>& texts,
                     const std::vector<std::string>& inputs);

// Checks that the folder is writable, or can be made.
Status check_folder_path(const std::string& folder);

// Makes the folder if it is missing. Fails if it is not writable.
Status make_output_folder(const std::string& folder);

std::string extension_of(const std::string& path); // in lower case, without its dot

// Returns true if two names lead to one file, even one not yet made. Pipes and devices never count as one.
bool same_file(const std::string& a, const std::string& b);

// Returns the 8-bit picture for a display, from linear pixels after exposure and tonemapping. Alpha is straight, not premultiplied.
// parts: samples of pixels that are not resolved as a plain mean.
Image display_picture(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts = {},
                      Resolve resolve = Resolve::linear, const Jobs* jobs = nullptr);

// Writes linear pixels to a float format, or exposed and tonemapped pixels to an 8-bit format, by extension.
Status write_picture(const std::string& path, const Image& linear, Tonemap tonemap, float exposure_ev,
                     const std::vector<PixelPart>& parts = {}, Resolve resolve = Resolve::linear, const Jobs* jobs = nullptr);

// Writes to a file (atomically), to standard output ("-"), or into an existing device or pipe.
Status write_text(const std::string& path, const std::string& text);

} // namespace burnish
