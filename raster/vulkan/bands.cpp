#include "raster/vulkan/bands.h"

#include <algorithm>
#include <fmt/format.h>

namespace burnish {

int band_rows(int width, int height, std::size_t bytes, std::size_t band_bytes)
{
    const std::size_t fit = band_bytes / (bytes * static_cast<std::size_t>(width)) & ~std::size_t{1};
    return static_cast<int>(std::clamp<std::size_t>(fit, 2, static_cast<std::size_t>(std::max(height, 2))));
}

std::vector<Band> bands_of(int height, int rows)
{
    std::vector<Band> bands;
    for (int y = 0; y < height; y += rows)
        bands.push_back({y, std::min(rows, height - y)});
    return bands;
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
