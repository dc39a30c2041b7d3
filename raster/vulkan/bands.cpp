#include "raster/vulkan/bands.h"

#include <algorithm>
#include <fmt/format.h>

namespace burnish {

int band_rows(int width, int height, std::size_t bytes, std::size_t band_bytes, int rim)
{
    const std::size_t fit = band_bytes / (bytes * static_cast<std::size_t>(width)) & ~std::size_t{1};
    const int most = std::max(height, 2), least = std::min(2 + 2 * rim, most);
    return static_cast<int>(std::clamp<std::size_t>(fit, static_cast<std::size_t>(least), static_cast<std::size_t>(most)));
}

std::vector<Band> bands_of(int height, int rows, int rim)
{
    if (rows >= height)
        return {{0, height, 0, height}};
    std::vector<Band> bands;
    const int step = rows - 2 * rim;
    for (int y = 0; y < height; y += step) {
        const int first = std::max(y - rim, 0), end = std::min(y + step, height), last = std::min(end + rim, height);
        bands.push_back({first, last - first, y - first, end - first});
    }
    return bands;
}

OwnPixels own_pixels(int width, const Band& band)
{
    const auto of = [&](int rows) { return static_cast<std::size_t>(width) * static_cast<std::size_t>(rows); };
    return {of(band.first_row + band.own_begin), of(band.own_begin), of(band.own_end - band.own_begin), of(band.rows)};
}

void require_limit(const Context& context, const char* field, const char* limit, std::uint64_t need, std::uint64_t have)
{
    if (need > have)
        throw VulkanError{Error{ExitCode::unavailable, "", "",
                                fmt::format("{} is needed of {}, {} has {}", need, limit, context.info().name, have), field}};
}

void require_width(const Context& context, int width)
{
    const Features& f = context.features();
    const auto need = static_cast<std::uint64_t>(width);
    require_limit(context, "FrameDesc::width", "maxImageDimension2D", need, f.max_image);
    require_limit(context, "FrameDesc::width", "maxFramebufferWidth", need, f.max_framebuffer_width);
    require_limit(context, "FrameDesc::width", "maxViewportDimensions", need, static_cast<std::uint64_t>(f.max_viewport));
}

} // namespace burnish
