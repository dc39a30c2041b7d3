// Replaces png_read.cpp, jpeg_read.cpp and webp_read.cpp in a program without libraries.
#include "core/image/io/common_formats.h"

namespace burnish {

std::optional<Status> read_png(const ImageBytes&, const ImageProbe&, const PlacePixels&)
{
    return std::nullopt;
}

std::optional<Status> read_jpeg(const ImageBytes&, const PlacePixels&)
{
    return std::nullopt;
}

std::optional<Status> read_webp(const ImageBytes&, const PlacePixels&)
{
    return std::nullopt;
}

std::string jpeg_warning(const ImageBytes&)
{
    return "";
}

} // namespace burnish
