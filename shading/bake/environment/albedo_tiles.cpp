#include "shading/bake/environment/albedo_tiles.h"

#include "shading/bake/environment/environment.h"

namespace burnish {

std::vector<float> albedo_tiles()
{
    constexpr std::size_t size = kLobeAlbedoSize, half = size / 2, side = size * half;
    static_assert(side == kAlbedoTilesSide);
    const float* const pairs = lobe_albedo_pairs();
    std::vector<float> texels(2 * side * side);
    for (std::size_t entry = 0; entry < side * side; ++entry) {
        const std::size_t x = entry % size, y = entry / size % size, z = entry / (size * size) % half, w = entry / (size * size * half);
        const std::size_t texel = (w * size + y) * side + z * size + x;
        texels[2 * texel] = pairs[2 * entry], texels[2 * texel + 1] = pairs[2 * entry + 1];
    }
    return texels;
}

} // namespace burnish
