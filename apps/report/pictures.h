// Pictures of a report, small enough for a page.
#pragma once
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// At most `width` pixels wide, each the mean of those that it covers; a float picture of any channels.
Image shrink(const Image& image, int width);

// How wide the pictures of a report of so many rows are: the page stays below some ten megabytes.
int picture_width(std::size_t rows);

Result<std::string> data_uri(const std::string& jpeg_file);

} // namespace burnish
