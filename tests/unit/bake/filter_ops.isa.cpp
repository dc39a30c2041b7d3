#include "tests/unit/bake/filter_ops.h"

#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/energy.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

// out[(i + lane) * count + c] = value[c] of the lane
BN_FN void scatter(const real* value, int count, int i, float* out)
{
    for (int c = 0; c < count; ++c) {
        float lane[kLanes];
        store(lane, value[c]);
        for (int k = 0; k < kLanes; ++k)
            out[(i + k) * count + c] = lane[k];
    }
}

void place_op(const float* x, const float* y, const float* z, int n, float* out)
{
    for (int i = 0; i < n; i += kLanes) {
        const cube_place p = cube_face_uv(vec3_of(load(x + i), load(y + i), load(z + i)));
        const real value[3] = {to_real(p.face), p.u, p.v};
        scatter(value, 3, i, out);
    }
}

void cube_op(const std::uint16_t* texels, int size, int levels, const float* x, const float* y, const float* z, const float* lod, int n,
             float* rgb)
{
    const cube_desc cube = {texels, size, levels};
    for (int i = 0; i < n; i += kLanes) {
        const real3 r = cube_sample(cube, vec3_of(load(x + i), load(y + i), load(z + i)), load(lod + i));
        const real value[3] = {r.x, r.y, r.z};
        scatter(value, 3, i, rgb);
    }
}

void cube_level_op(const std::uint16_t* texels, int size, int levels, int level, const float* x, const float* y, const float* z, int n,
                   float* rgb)
{
    const cube_desc cube = {texels, size, levels};
    for (int i = 0; i < n; i += kLanes) {
        const real3 r = cube_sample_level(cube, vec3_of(load(x + i), load(y + i), load(z + i)), level);
        const real value[3] = {r.x, r.y, r.z};
        scatter(value, 3, i, rgb);
    }
}

BN_FN texture_desc desc_of(const TextureView& t)
{
    return {t.texels, t.offset, t.level_width, t.level_height, t.levels, t.wrap_s, t.wrap_t, t.nearest};
}

BN_FN texture_footprint footprint_at(const texture_desc& desc, const float* uv, int n, int i, int max_taps)
{
    return texture_footprint_of(desc, vec2_of(load(uv + 2 * n + i), load(uv + 3 * n + i)),
                                vec2_of(load(uv + 4 * n + i), load(uv + 5 * n + i)), max_taps);
}

void texture_op(const TextureView& texture, const float* uv, int max_taps, bool exact_bound, int n, float* rgba)
{
    const texture_desc desc = desc_of(texture);
    for (int i = 0; i < n; i += kLanes) {
        const real2 at = vec2_of(load(uv + i), load(uv + n + i));
        real4 r;
        if (exact_bound) {
            const texture_footprint p = footprint_at(desc, uv, n, i, max_taps);
            float taps[kLanes];
            store(taps, reduce_max(p.taps));
            r = texture_sample_footprint(desc, at, p, static_cast<int>(taps[0]));
        } else {
            r = texture_sample(desc, at, vec2_of(load(uv + 2 * n + i), load(uv + 3 * n + i)),
                               vec2_of(load(uv + 4 * n + i), load(uv + 5 * n + i)), max_taps);
        }
        const real value[4] = {r.x, r.y, r.z, r.w};
        scatter(value, 4, i, rgba);
    }
}

void footprint_op(const TextureView& texture, const float* uv, int max_taps, int n, float* lod_taps)
{
    const texture_desc desc = desc_of(texture);
    for (int i = 0; i < n; i += kLanes) {
        const texture_footprint p = footprint_at(desc, uv, n, i, max_taps);
        const real value[2] = {p.lod, p.taps};
        scatter(value, 2, i, lod_taps);
    }
}

void dfg_lookup_op(const std::uint16_t* table, int size, const float* n_dot_v, const float* roughness, int n, float* scale_bias)
{
    for (int i = 0; i < n; i += kLanes) {
        const dfg_value d = dfg_lookup(table, size, load(n_dot_v + i), load(roughness + i));
        const real value[2] = {d.scale, d.bias};
        scatter(value, 2, i, scale_bias);
    }
}

template <bool kSlice> void lobe_albedo_op(const std::uint16_t* table, int size, const float* lobes, int n, float* scale_bias)
{
    const real zero = lit(0.0), one = lit(1.0);
    for (int i = 0; i < n; i += kLanes) {
        const aniso_lobe lobe = {vec3_of(one, zero, zero), vec3_of(zero, one, zero), load(lobes + i), load(lobes + n + i)};
        const real3 v = vec3_of(load(lobes + 2 * n + i), load(lobes + 3 * n + i), load(lobes + 4 * n + i)), up = vec3_of(zero, zero, one);
        const dfg_value d = kSlice ? lobe_slice_lookup(table, 0, size, lobe, up, v) : lobe_albedo_lookup(table, size, lobe, up, v);
        const real value[2] = {d.scale, d.bias};
        scatter(value, 2, i, scale_bias);
    }
}

void dfg_fit_op(const float* n_dot_v, const float* roughness, int n, float* scale_bias)
{
    for (int i = 0; i < n; i += kLanes) {
        const dfg_value d = dfg_fit(load(n_dot_v + i), load(roughness + i));
        const real value[2] = {d.scale, d.bias};
        scatter(value, 2, i, scale_bias);
    }
}

constexpr FilterOps kOps = {
    kLanes,    place_op, cube_op, cube_level_op, texture_op, footprint_op, dfg_lookup_op, lobe_albedo_op<true>, lobe_albedo_op<false>,
    dfg_fit_op};

} // namespace

BN_DEFINE_FNS(FilterOps, kOps)

} // namespace BN_ISA_NS
} // namespace burnish
