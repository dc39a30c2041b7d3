#include "apps/risks/sky.h"

#include <algorithm>
#include <cmath>

#include "core/simd/half.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {
namespace {

constexpr int kMostSide = 128; // texels: finer levels are not used

// Components of a direction that are a face's coordinates, with their signs, as in cube_map.h.
struct Face {
    std::size_t u, v;
    float u_sign, v_sign;
};
constexpr Face kFaces[6] = {{2, 1, -1.0f, -1.0f}, {2, 1, 1.0f, -1.0f}, {0, 2, 1.0f, 1.0f},
                            {0, 2, 1.0f, -1.0f},  {0, 1, 1.0f, -1.0f}, {0, 1, -1.0f, -1.0f}};

} // namespace

Sky::Sky(const Environment& environment) : cube_(environment.specular)
{
    last_ = static_cast<float>(cube_.levels - 1);
    while (first_ + 1 < cube_.levels && (cube_.size >> first_) > kMostSide)
        ++first_;
}

float Sky::at(const glm::vec3& d, int wanted) const
{
    const int level = std::clamp(wanted, first_, cube_.levels - 1), side = cube_.size >> level;
    const float c[3] = {d.x, d.y, d.z}, ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z), most = std::max(ax, ay);
    const std::size_t axis = az > most ? 2 : ay > ax ? 1 : 0, face = 2 * axis + (c[axis] > 0.0f ? 0 : 1);
    const Face& f = kFaces[face]; // a table lookup: branches here would be mispredicted
    const float u = f.u_sign * c[f.u], v = f.v_sign * c[f.v], major = std::max(ax, std::max(ay, az));
    const float half = 0.5f * static_cast<float>(side), over = half / std::max(major, 1e-20f);
    const auto texel = [&](float x) { return static_cast<std::size_t>(std::clamp(static_cast<int>(x * over + half), 0, side - 1)); };
    const std::size_t row = static_cast<std::size_t>(side) + 2; // includes the border
    const std::uint16_t* rgb =
        cube_.texels.data() + 4 * (cube_.offset[static_cast<std::size_t>(level)] + (face * row + texel(v) + 1) * row + texel(u) + 1);
    return cube_.scale *
           (static_cast<float>(kLuminance[0]) * half_to_float(rgb[0]) + static_cast<float>(kLuminance[1]) * half_to_float(rgb[1]) +
            static_cast<float>(kLuminance[2]) * half_to_float(rgb[2]));
}

} // namespace burnish
