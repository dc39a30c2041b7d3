// Writes pictures that memory does not hold: by rows, from the top down.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

struct StreamedPicture {
    int width = 0, height = 0, channels = 3;
    std::vector<std::string> channel_names; // of .exr; empty: the default names for the channel count
    int tile = 0;                           // pixels along a side of .exr tiles; 0: no tiles
};

class ImageStream {
  public:
    virtual ~ImageStream() = default;
    // Appends rows: floats for .exr, 8 bits for .png. Before the last rows, their number must be a multiple of 16, or of the tile.
    virtual Status add(const Image& rows) = 0;
    // Completes the file. The file gets its name here. Without this, nothing is left.
    virtual Status finish() = 0;
};

// Returns true where the extension of `path` names a format that is written by rows (exr, png).
bool writes_rows(const std::string& path);

// Begins a file. Files have the bytes of write_image() where there are no tiles. Errors: ExitCode::output_failed, also for other formats.
Result<std::unique_ptr<ImageStream>> open_image_stream(const std::string& path, const StreamedPicture& picture);

} // namespace burnish
