// Gathers triangle setups for kLanes fragments, for shading/surface/visible_point.t.h.
#pragma once
#include "raster/frame/lane_material.h"
#include "raster/tile/tile_types.h"
#include "shading/surface/parallax.t.h"
#include "shading/surface/visible_point.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr std::int32_t kManyTriangles = -1;

struct LaneSetup : triangle_setup { // setups of the fragments' triangles, one register per field
    std::int32_t common_vertex[3];  // set if all fragments share one whole triangle; else kManyTriangles
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

// Fills r. common: the triangle of all fragments, or kManyTriangles.
BN_INLINE void load_setup(const TileScratch& scratch, integer triangle, std::int32_t common, LaneSetup& r)
{
    r.common_vertex[0] = kManyTriangles;
    if (common != kManyTriangles) {
        const TriangleSetup& t = scratch.triangles[common];
        for (int k = 0; k < 3; ++k)
            r.x[k] = int_lit(t.x[k]), r.y[k] = int_lit(t.y[k]), r.vertex[k] = int_lit(t.vertex[k]);
        r.inv_w = vec3_of(splat(t.inv_w[0]), splat(t.inv_w[1]), splat(t.inv_w[2]));
        r.info = int_lit(t.info);
        for (int k = 0; k < 3 && !(t.info & kClipped); ++k)
            r.common_vertex[k] = t.vertex[k];
    } else {
        integer field[16];
        load_records16(scratch.triangles, triangle, field);
        for (int k = 0; k < 3; ++k)
            r.x[k] = field[k], r.y[k] = field[3 + k], r.vertex[k] = field[12 + k];
        r.inv_w = vec3_of(real_from_bits(field[6]), real_from_bits(field[7]), real_from_bits(field[8]));
        r.info = field[15];
    }
    // Replace clipped pieces' corners by the whole triangle's vertices
    r.piece = (r.info & int_lit(kClipped)) != int_lit(0);
    r.clipped = any(r.piece);
    if (r.clipped)
        unclip_setup(scratch, r.piece, r);
}

// Customization points of shading/inputs/triangle.h:

// Blends words c to c + 3 if all fragments share one whole triangle.
BN_INLINE void blend_common(any_frame f, const LaneSetup& t, real3 b, int c, real to[4])
{
    const auto words = [&](int k) { return f.shading_vertices + std::size_t{16} * static_cast<std::uint32_t>(t.common_vertex[k]) + c; };
    const float *const v0 = words(0), *const v1 = words(1), *const v2 = words(2);
    to[0] = b.x * splat(v0[0]) + b.y * splat(v1[0]) + b.z * splat(v2[0]);
    to[1] = b.x * splat(v0[1]) + b.y * splat(v1[1]) + b.z * splat(v2[1]);
    to[2] = b.x * splat(v0[2]) + b.y * splat(v1[2]) + b.z * splat(v2[2]);
    to[3] = b.x * splat(v0[3]) + b.y * splat(v1[3]) + b.z * splat(v2[3]);
}

BN_INLINE real4 vertex_coordinates(any_frame f, const LaneSetup& t, int k)
{
    if (t.common_vertex[0] != kManyTriangles) {
        const float* const v = f.shading_vertices + std::size_t{16} * static_cast<std::uint32_t>(t.common_vertex[k]) + 8;
        return vec4_of(splat(v[0]), splat(v[1]), splat(v[2]), splat(v[3]));
    }
    integer words[4];
    load_quads(f.shading_vertices + 8, shl(t.vertex[k], 2), words);
    return vec4_of(real_from_bits(words[0]), real_from_bits(words[1]), real_from_bits(words[2]), real_from_bits(words[3]));
}

BN_INLINE void blend_vertices(any_frame f, const LaneSetup& t, real3 b, bool all_words, vertex_words& a)
{
    for (int c = 8; c < 16 && !all_words; ++c)
        a.at[c] = lit(0.0);
    if (t.common_vertex[0] != kManyTriangles) {
        blend_common(f, t, b, 0, a.at), blend_common(f, t, b, 4, a.at + 4);
        if (all_words)
            blend_common(f, t, b, 8, a.at + 8), blend_common(f, t, b, 12, a.at + 12);
    } else if (all_words) {
        blend_records(f.shading_vertices, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, a.at);
    } else {
        blend_records_low(f.shading_vertices, t.vertex[0], t.vertex[1], t.vertex[2], b.x, b.y, b.z, a.at);
    }
}

BN_INLINE real3 vertex_place(any_frame f, const LaneSetup& t, int k)
{
    return vec3_of(gather(f.px, t.vertex[k]), gather(f.py, t.vertex[k]), gather(f.pz, t.vertex[k]));
}

// Interpolates fragments. samples: covered sample mask. pixel_x, pixel_y: in the image. lights: there are lights that need the position.
// bends: as in point_of().
BN_INLINE visible_point fragment_of(frame_ref f, material_ref m, const view_params& view, const LaneSetup& t, integer pixel_x,
                                    integer pixel_y, integer samples, bool lights, bool bends)
{
    visible_point p = point_of(f, view, t, pixel_x, pixel_y, samples, m.uses_color != 0, m.textured != 0, lights, bends);
    if (m.parallax != 0)
        apply_parallax(f, m, parallax_plane_of(f, t), p);
    return p;
}

// Loads the setups and interpolates. common: the triangle of all fragments, or kManyTriangles.
BN_INLINE visible_point make_fragment_inline(frame_ref f, material_ref m, const view_params& view, const TileScratch& scratch,
                                             integer triangle, std::int32_t common, integer pixel_x, integer pixel_y, integer samples,
                                             bool lights, bool bends)
{
    LaneSetup t;
    load_setup(scratch, triangle, common, t);
    return fragment_of(f, m, view, t, pixel_x, pixel_y, samples, lights, bends);
}

// Not inlined: compiled once per file.
BN_STAGE visible_point make_fragment(const FrameParams& f, const MaterialRecord& m, const view_params& view, const TileScratch& scratch,
                                     integer triangle, std::int32_t common, integer pixel_x, integer pixel_y, integer samples)
{
    return make_fragment_inline(f, m, view, scratch, triangle, common, pixel_x, pixel_y, samples, f.positions != 0, wants_bends(f, m));
}

} // namespace BN_ISA_NS
} // namespace burnish
