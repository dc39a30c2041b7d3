// Report pictures, reduced to page size.
#pragma once
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// Shrinks a float picture with any channels to at most `width` pixels wide. Each pixel is the mean of the pixels it covers.
Image shrink(const Image& image, int width);
// Shrinks like shrink(), to at most `side` pixels wide and high.
Image shrink_within(const Image& image, int side);

// Returns the picture width for a report with this many rows. The page stays below about ten megabytes.
int picture_width(std::size_t rows);

Result<std::string> data_uri(const std::string& jpeg_file);

} // namespace burnish
