#include "apps/atlas/sky.h"

#include <algorithm>
#include <cmath>

#include "core/simd/half.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {
namespace {

constexpr int kMostSide = 128; // texels: finer ones are not told apart

// Which components of a direction are a face's coordinates, and their signs, as cube_map.h has them.
struct Face {
    std::size_t u, v;
    float u_sign, v_sign;
};
constexpr Face kFaces[6] = {{2, 1, -1.0f, -1.0f}, {2, 1, 1.0f, -1.0f}, {0, 2, 1.0f, 1.0f},
                            {0, 2, 1.0f, -1.0f},  {0, 1, 1.0f, -1.0f}, {0, 1, -1.0f, -1.0f}};

} // namespace

Sky::Sky(const Environment& environment, float least)
{
    const CubeMap& cube = environment.specular;
    last_ = static_cast<float>(cube.levels - 1);
    while (first_ + 1 < cube.levels && (cube.size >> first_) > kMostSide)
        ++first_;
    first_ = std::clamp(level_of(least), first_, cube.levels - 1);
    for (int l = first_; l < cube.levels; ++l) {
        Level& level = levels_.emplace_back();
        level.size = cube.size >> l;
        const std::size_t side = static_cast<std::size_t>(level.size);
        level.luminance.resize(6 * side * side);
        std::size_t to = 0;
        for (std::size_t face = 0; face < 6; ++face)
            for (std::size_t y = 0; y < side; ++y) {
                const std::uint16_t* texel =
                    cube.texels.data() + 4 * (cube.offset[static_cast<std::size_t>(l)] + (face * (side + 2) + y + 1) * (side + 2) + 1);
                for (std::size_t x = 0; x < side; ++x, texel += 4)
                    level.luminance[to++] = cube.scale * (static_cast<float>(kLuminance[0]) * half_to_float(texel[0]) +
                                                          static_cast<float>(kLuminance[1]) * half_to_float(texel[1]) +
                                                          static_cast<float>(kLuminance[2]) * half_to_float(texel[2]));
            }
    }
}

float Sky::at(const glm::vec3& d, int wanted) const
{
    const Level& level = levels_[static_cast<std::size_t>(std::clamp(wanted - first_, 0, static_cast<int>(levels_.size()) - 1))];
    const float c[3] = {d.x, d.y, d.z}, ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z), most = std::max(ax, ay);
    const std::size_t axis = az > most ? 2 : ay > ax ? 1 : 0, face = 2 * axis + (c[axis] > 0.0f ? 0 : 1);
    const Face& f = kFaces[face]; // a table: branches would be taken at random
    const float u = f.u_sign * c[f.u], v = f.v_sign * c[f.v], major = std::max(ax, std::max(ay, az));
    const float half = 0.5f * static_cast<float>(level.size), over = half / std::max(major, 1e-20f);
    const auto texel = [&](float x) { return std::clamp(static_cast<int>(x * over + half), 0, level.size - 1); };
    return level.luminance[static_cast<std::size_t>((static_cast<int>(face) * level.size + texel(v)) * level.size + texel(u))];
}

} // namespace burnish
