#include "apps/lab/ltc/preview.h"

#include <algorithm>
#include <fmt/core.h>

#include "core/image/magma.h"

namespace burnish {

Preview names_of_ltc()
{
    Preview pictures;
    for (std::size_t channel = 0; channel < ltc::kChannels; ++channel)
        pictures.push_back({channel < 9 ? fmt::format("m{}{}", channel / 3, channel % 3) : channel == 9 ? "nD" : "fD", {}});
    return pictures;
}

Preview preview_of_ltc(const ltc::Table& table)
{
    const auto [thetas, phis, alphas, lambdas] = table.grid.sizes();
    const int width = alphas * lambdas;
    Preview pictures = names_of_ltc();
    for (std::size_t channel = 0; channel < ltc::kChannels; ++channel) {
        Image values = make_image(width, thetas * phis, 1, PixelType::f32);
        const std::size_t count = static_cast<std::size_t>(values.width) * static_cast<std::size_t>(values.height);
        float least = table.entries[channel], most = least;
        for (std::size_t i = 0; i < count; ++i) {
            const float value = table.entries[ltc::kChannels * i + channel];
            values.f32()[i] = value;
            least = std::min(least, value), most = std::max(most, value);
        }
        for (std::size_t i = 0; i < count; ++i)
            values.f32()[i] = most > least ? (values.f32()[i] - least) / (most - least) : 0.0f;
        pictures[channel].image = enlarged(magma_map(values));
    }
    return pictures;
}

} // namespace burnish
