#include "bench/micro/bake_fetch.h"

#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

BN_FN void store_rgb(real4 value, float* rgb)
{
    store(rgb, value.x);
    store(rgb + kLanes, value.y);
    store(rgb + 2 * kLanes, value.z);
}

void single(const std::uint16_t* texels, int size, int levels, const FetchInput& in, float* rgb)
{
    const cube_desc cube = {texels, size, levels};
    for (int i = 0; i < in.n; i += kLanes, rgb += 3 * kLanes) {
        const real3 d = vec3_of(load(in.x + i), load(in.y + i), load(in.z + i));
        store_rgb(texel_value(cube_texel_add(texel_zero(), cube, d, load(in.lod + i), lit(1.0))), rgb);
    }
}

void sixteen(const std::uint16_t* texels, int size, int levels, const FetchInput& in, float* rgb)
{
    const cube_desc cube = {texels, size, levels};
    for (int i = 0; i < in.n; i += kLanes, rgb += 3 * kLanes) {
        real3 d = vec3_of(load(in.x + i), load(in.y + i), load(in.z + i));
        const real3 step = vec3_of(d.y, d.z, d.x) * lit(0.02);
        texel_acc acc = texel_zero();
        for (int k = 0; k < 16; ++k) {
            acc = cube_texel_add(acc, cube, d, load(in.lod + i), lit(0.0625));
            d = d + step;
        }
        store_rgb(texel_value(acc), rgb);
    }
}

void texture(const TextureParams& t, int taps, const FetchInput& in, float* rgb)
{
    const texture_desc desc = {t.texels, t.offset, t.level_width, t.level_height, t.levels, t.wrap_s, t.wrap_t, t.nearest};
    const real across = splat(1.0f / static_cast<float>(t.width)), along = splat(4.0f / static_cast<float>(t.height));
    for (int i = 0; i < in.n; i += kLanes, rgb += 3 * kLanes)
        store_rgb(texture_sample(desc, vec2_of(load(in.x + i), load(in.y + i)), vec2_of(across, lit(0.0)), vec2_of(lit(0.0), along), taps),
                  rgb);
}

constexpr FetchFns kFns = {single, sixteen, texture};

} // namespace

BN_DEFINE_FNS(FetchFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
