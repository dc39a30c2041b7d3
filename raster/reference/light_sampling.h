// Samples the environment's table in lanes (environment_sampler.h).
#pragma once
#include "core/simd/lanes.h"
#include "raster/reference/environment_sampler.h"
#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct LightSample {
    real3 wi; // unit, world space
    real pdf; // 1/sr
};

// Returns area on the face over solid angle, at (u, v) in [-1,1]^2.
BN_INLINE real area_by_solid_angle(real u, real v)
{
    const real r2 = lit(1.0) + u * u + v * v;
    return r2 * sqrt(r2);
}

// Chooses the first part, with probability p, or the second. Stretches the remainder of x to [0, 1). Returns the lanes with the second
// part.
BN_INLINE mask take_second(real& x, real p)
{
    const mask second = x >= p;
    const real rest = max(lit(1.0) - p, lit(1e-20));
    const real scaled = select(second, (x - p) / rest, x / max(p, lit(1e-20)));
    x = min(max(scaled, lit(0.0)), lit(0.99999994));
    return second;
}

// Draws a direction. xi: [0,1)^2.
BN_INLINE LightSample sample_environment(const EnvironmentSamplerView& s, real2 xi)
{
    integer face = int_lit(0);
    real begin = lit(0.0), end = splat(s.face_end[0]);
    for (int f = 1; f < 6; ++f) {
        const mask beyond = xi.x >= splat(s.face_end[f - 1]);
        face = select(beyond, int_lit(f), face);
        begin = select(beyond, splat(s.face_end[f - 1]), begin);
        end = select(beyond, splat(s.face_end[f]), end);
    }
    real x = min((xi.x - begin) / max(end - begin, lit(1e-20)), lit(0.99999994)), y = xi.y;
    integer ix = int_lit(0), row = face; // row: over all faces
    // Descend the quadtree
    for (int l = 0; l < s.levels; ++l) {
        const integer node = int_lit(s.offset[l]) + shl(row, l) + ix;
        const integer right = select(take_second(x, gather(s.left, node)), int_lit(1), int_lit(0));
        const integer lower = select(take_second(y, gather(s.upper, shl(node, 1) + right)), int_lit(1), int_lit(0));
        ix = shl(ix, 1) + right;
        row = shl(row, 1) + lower;
    }
    // Convert the cell to a direction
    const real texel = lit(2.0) / to_real(int_lit(s.size));
    const integer iy = row - shl(face, s.levels);
    const real u = (to_real(ix) + x) * texel - lit(1.0), v = (to_real(iy) + y) * texel - lit(1.0);
    const integer axis = shr(face, 1);
    const real sign = select((face & int_lit(1)) != int_lit(0), lit(-1.0), lit(1.0));
    const mask is_x = axis == int_lit(0), is_y = axis == int_lit(1);
    LightSample r;
    r.wi.x = select(is_x, sign, select(is_y, u, u * sign));
    r.wi.y = select(is_y, sign, -v);
    r.wi.z = select(is_x, -u * sign, select(is_y, v * sign, sign));
    r.wi = k_normalize3(r.wi);
    r.pdf = gather(s.density, row * int_lit(s.size) + ix) * area_by_solid_angle(u, v);
    return r;
}

// Returns the density of direction d, with any length.
BN_INLINE real environment_pdf(const EnvironmentSamplerView& s, real3 d)
{
    const cube_place p = cube_face_uv(d);
    const real size = to_real(int_lit(s.size));
    const integer last = int_lit(s.size - 1);
    const integer ix = min(to_int(p.u * size), last), iy = min(to_int(p.v * size), last);
    const integer at = (p.face * int_lit(s.size) + iy) * int_lit(s.size) + ix;
    return gather(s.density, at) * area_by_solid_angle(p.u * lit(2.0) - lit(1.0), p.v * lit(2.0) - lit(1.0));
}

} // namespace BN_ISA_NS
} // namespace burnish
