// From the tile's triangles to kLanes fragments: attributes interpolated at the shaded point, and the derivatives that a GPU would see
// (differences in the 2x2 quad, taken from the plane equations, so no helper lanes run).
#pragma once
#include "raster/frame/lane_material.h"
#include "raster/tile/tile_types.h"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/interpolate.k.h"
#include "shading/surface/coverage.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr std::int32_t kManyTriangles = -1;

struct LaneSetup { // setups of the fragments' triangles, a field a register
    integer x[3], y[3];
    real3 inv_w;
    integer vertex[3];
    integer info;
    real3 unclip[3]; // corners of a clipped piece in barycentrics of the whole triangle
    bool any_clipped;
    std::int32_t common_vertex[3]; // where all fragments are of one whole triangle; else kManyTriangles
};

BN_INLINE void unclip_setup(const TileScratch& scratch, mask clipped, LaneSetup& r)
{
    std::int32_t vertex[3][kLanes];
    float bary[9][kLanes];
    for (int k = 0; k < 3; ++k)
        store_int(vertex[k], r.vertex[k]);
    for (int k = 0; k < 9; ++k)
        store(bary[k], lit(k % 4 == 0 ? 1.0 : 0.0));
    for (std::uint32_t bits = to_bits(clipped); bits; bits &= bits - 1) {
        const int i = __builtin_ctz(bits);
        const ClipRecord& c = scratch.clips[vertex[0][i]];
        for (int k = 0; k < 9; ++k)
            bary[k][i] = c.bary[k];
        for (int k = 0; k < 3; ++k)
            vertex[k][i] = c.vertex[k];
    }
    for (int k = 0; k < 3; ++k) {
        r.vertex[k] = load_int(vertex[k]);
        r.unclip[k] = vec3_of(load(bary[3 * k]), load(bary[3 * k + 1]), load(bary[3 * k + 2]));
    }
}

// common: the triangle of all fragments, or kManyTriangles.
BN_INLINE LaneSetup load_setup(const TileScratch& scratch, integer triangle, std::int32_t common)
{
    integer field[16];
    LaneSetup r;
    r.common_vertex[0] = kManyTriangles;
    if (common != kManyTriangles) {
        std::int32_t words[16];
        __builtin_memcpy(words, scratch.triangles + common, sizeof words);
        for (int k = 0; k < 16; ++k)
            field[k] = int_lit(words[k]);
        for (int k = 0; k < 3 && !(words[15] & kClipped); ++k)
            r.common_vertex[k] = words[12 + k];
    } else {
        load_records16(scratch.triangles, triangle, field);
    }
    for (int k = 0; k < 3; ++k) {
        r.x[k] = field[k];
        r.y[k] = field[3 + k];
        r.vertex[k] = field[12 + k];
    }
    r.inv_w = vec3_of(real_from_bits(field[6]), real_from_bits(field[7]), real_from_bits(field[8]));
    r.info = field[15];
    const mask clipped = (r.info & int_lit(kClipped)) != int_lit(0);
    r.any_clipped = any(clipped);
    if (r.any_clipped)
        unclip_setup(scratch, clipped, r);
    return r;
}

// Weights of the whole triangle's vertices at a point, 1/256 pixel.
BN_INLINE bary_weights weights_at(const LaneSetup& t, integer x, integer y)
{
    bary_weights w = perspective_weights(vec3_of(to_real(t.x[0] - x), to_real(t.x[1] - x), to_real(t.x[2] - x)),
                                         vec3_of(to_real(t.y[0] - y), to_real(t.y[1] - y), to_real(t.y[2] - y)), t.inv_w);
    if (t.any_clipped)
        w.b = unclip_weights(w.b, t.unclip[0], t.unclip[1], t.unclip[2]);
    return w;
}

struct ShadePoint {
    integer x, y; // 1/256 pixel
};

// The pixel's centre where the triangle covers it; else the mean of the visible samples, which lies in the triangle.
BN_INLINE ShadePoint shade_point(const FrameParams& f, integer corner_x, integer corner_y, integer samples, mask center_inside)
{
    ShadePoint p = {corner_x + int_lit(kSubpixel / 2), corner_y + int_lit(kSubpixel / 2)};
    if (all(center_inside))
        return p;
    const sample_mean mean = mean_of_samples(f, samples);
    p.x = select(center_inside, p.x, corner_x + mean.x);
    p.y = select(center_inside, p.y, corner_y + mean.y);
    return p;
}

BN_INLINE void interpolate_uv(const FrameParams& f, const LaneSetup& t, real3 b, real2 uv[2])
{
    real r[4];
    blend_quad(f.shading_vertices + 8, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, r);
    uv[0] = vec2_of(r[0], r[1]);
    uv[1] = vec2_of(r[2], r[3]);
}

// The first `count` floats of the vertices' records, blended.
BN_INLINE void interpolate_records(const FrameParams& f, const LaneSetup& t, real3 b, real* out, int count)
{
    if (t.common_vertex[0] == kManyTriangles) {
        if (count > 8)
            blend_records(f.shading_vertices, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, out);
        else
            blend_records_low(f.shading_vertices, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, out);
        return;
    }
    const float* v0 = f.shading_vertices + std::size_t{16} * static_cast<std::uint32_t>(t.common_vertex[0]);
    const float* v1 = f.shading_vertices + std::size_t{16} * static_cast<std::uint32_t>(t.common_vertex[1]);
    const float* v2 = f.shading_vertices + std::size_t{16} * static_cast<std::uint32_t>(t.common_vertex[2]);
    for (int c = 0; c < count; ++c)
        out[c] = b.x * splat(v0[c]) + b.y * splat(v1[c]) + b.z * splat(v2[c]);
}

BN_INLINE real blend_gather(const float* column, const LaneSetup& t, real3 b)
{
    return b.x * gather(column, t.vertex[0]) + b.y * gather(column, t.vertex[1]) + b.z * gather(column, t.vertex[2]);
}

// common: the triangle of all fragments, or kManyTriangles. samples: covered sample mask. pixel_x, pixel_y: in the image. lights: there are
// some, which ask for the position.
BN_INLINE visible_point make_fragment_inline(const FrameParams& f, material_ref m, const view_params& view, const TileScratch& scratch,
                                             integer triangle, std::int32_t common, integer pixel_x, integer pixel_y, integer samples,
                                             bool lights)
{
    const LaneSetup t = load_setup(scratch, triangle, common);
    const integer corner_x = shl(pixel_x, 8) - int_lit(f.center_x), corner_y = shl(pixel_y, 8) - int_lit(f.center_y);
    const integer half = int_lit(kSubpixel / 2);
    const bary_weights center = weights_at(t, corner_x + half, corner_y + half);
    bary_weights w = center;
    ShadePoint point = {corner_x + half, corner_y + half};
    if (!all(center.inside)) {
        point = shade_point(f, corner_x, corner_y, samples, center.inside);
        w = weights_at(t, point.x, point.y);
    }
    visible_point p;
    real a[16]; // the upper half is read only where it was fetched
    if (m.textured || m.uses_color)
        interpolate_records(f, t, w.b, a, 16);
    else
        interpolate_records(f, t, w.b, a, 8);
    p.normal = vec3_of(a[0], a[1], a[2]);
    p.tangent = vec3_of(a[3], a[4], a[5]);
    p.tangent_sign = select(a[6] < lit(0.0), lit(-1.0), lit(1.0));
    p.front = (t.info & int_lit(kFrontFacing)) != int_lit(0);
    const real to_pixels = lit(1.0 / kSubpixel);
    p.ray = ray_through(f, view, to_real(point.x + int_lit(f.center_x)) * to_pixels, to_real(point.y + int_lit(f.center_y)) * to_pixels);
    if (lights)
        p.position = vec3_of(blend_gather(f.px, t, w.b), blend_gather(f.py, t, w.b), blend_gather(f.pz, t, w.b));
    if (m.uses_color)
        p.color = vec4_of(a[12], a[13], a[14], a[15]);
    if (!m.textured)
        return p;
    p.uv[0] = vec2_of(a[8], a[9]);
    p.uv[1] = vec2_of(a[10], a[11]);
    // the other pixel of the quad in x and in y: to the right of or below an even one, to the left of or above an odd one
    const integer odd_x = pixel_x & int_lit(1), odd_y = pixel_y & int_lit(1), pixel = int_lit(kSubpixel);
    const integer step_x = pixel - odd_x * (pixel + pixel), step_y = pixel - odd_y * (pixel + pixel);
    real2 uv_center[2], uv_x[2], uv_y[2];
    interpolate_uv(f, t, center.b, uv_center);
    interpolate_uv(f, t, weights_at(t, corner_x + half + step_x, corner_y + half).b, uv_x);
    interpolate_uv(f, t, weights_at(t, corner_x + half, corner_y + half + step_y).b, uv_y);
    const real sign_x = to_real(int_lit(1) - odd_x * int_lit(2)), sign_y = to_real(int_lit(1) - odd_y * int_lit(2));
    for (int i = 0; i < 2; ++i) {
        p.uv_dx[i] = (uv_x[i] - uv_center[i]) * sign_x;
        p.uv_dy[i] = (uv_y[i] - uv_center[i]) * sign_y;
    }
    return p;
}

// Compiled once in a file.
BN_STAGE visible_point make_fragment(const FrameParams& f, const MaterialRecord& m, const view_params& view, const TileScratch& scratch,
                                     integer triangle, std::int32_t common, integer pixel_x, integer pixel_y, integer samples)
{
    return make_fragment_inline(f, m, view, scratch, triangle, common, pixel_x, pixel_y, samples, f.light_count > 0);
}

} // namespace BN_ISA_NS
} // namespace burnish
