#include "apps/bake/lobe_maps.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "core/math/scalar_math.h"
#include "shading/bake/mip/anisotropy.h"

namespace burnish {
namespace {

constexpr double kMostSquares = 1 << 22; // of a lobe; a larger part is read in steps

class Field {
  public:
    Field(const Image& heights, double depth) : heights_(heights), depth_(depth) {}
    // Returns the slopes of both triangles of each square of texels in a part, along tangent (right) and bitangent (up).
    std::vector<glm::dvec2> slopes(int left, int right, int top, int bottom) const
    {
        const double across = depth_ * heights_.width, up = depth_ * heights_.height;
        const int step = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(right - left) * (bottom - top) / kMostSquares)));
        std::vector<glm::dvec2> out;
        for (int y = top; y < bottom; y += step)
            for (int x = left; x < right; x += step) {
                const double a = at(x, y), b = at(x + 1, y), c = at(x, y + 1), d = at(x + 1, y + 1);
                out.emplace_back((b - a) * across, (a - c) * up);
                out.emplace_back((d - c) * across, (b - d) * up);
            }
        return out;
    }

  private:
    double at(int x, int y) const
    {
        const std::size_t column = static_cast<std::size_t>(x % heights_.width), row = static_cast<std::size_t>(y % heights_.height);
        const double value = static_cast<double>(texel_channel(heights_, row * static_cast<std::size_t>(heights_.width) + column, 0));
        return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
    }
    const Image& heights_;
    double depth_;
};

} // namespace

Result<LobeMaps> lobe_maps(const Image& heights, double depth, int width, int height, SlopeModel model, const Jobs& jobs)
{
    if (heights.width / width < kLeastHeights || heights.height / height < kLeastHeights)
        return Error{ExitCode::usage, "", "",
                     fmt::format("{}x{} lobes from {}x{} heights: a lobe needs {}x{}", width, height, heights.width, heights.height,
                                 kLeastHeights, kLeastHeights)};
    const Field field(heights, depth);
    std::vector<SlopeLobe> lobes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    jobs.parallel_for_whole(lobes.size(), [&](std::size_t i, int) {
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        lobes[i] = fit_slope_lobe(field.slopes(x * heights.width / width, (x + 1) * heights.width / width, y * heights.height / height,
                                               (y + 1) * heights.height / height),
                                  model);
    });
    LobeMaps maps;
    for (Image* map : {&maps.roughness, &maps.rotation, &maps.normal})
        *map = make_image(width, height, 3, PixelType::f32);
    const auto put = [](Image& map, std::size_t i, double r, double g, double b) {
        float* const to = map.f32() + 3 * i;
        to[0] = static_cast<float>(r), to[1] = static_cast<float>(g), to[2] = static_cast<float>(b);
    };
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const SlopeLobe& lobe = lobes[i];
        maps.clamped += lobe.alpha_along > 1.0;
        put(maps.roughness, i, std::min(lobe.alpha_along, 1.0), std::min(lobe.alpha_across, 1.0), 0.0);
        put(maps.rotation, i, det_cos(lobe.angle), det_sin(lobe.angle), 0.0);
        const double length = std::sqrt(1.0 + lobe.mean.x * lobe.mean.x + lobe.mean.y * lobe.mean.y);
        put(maps.normal, i, 0.5 - 0.5 * lobe.mean.x / length, 0.5 - 0.5 * lobe.mean.y / length, 0.5 + 0.5 / length);
    }
    const auto middle = lobes.begin() + static_cast<std::ptrdiff_t>(lobes.size() / 2);
    std::nth_element(lobes.begin(), middle, lobes.end(), [](const SlopeLobe& a, const SlopeLobe& b) { return a.distance < b.distance; });
    maps.middle = *middle;
    return maps;
}

} // namespace burnish
