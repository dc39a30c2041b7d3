// Compensation for multiple scattering between microfacets: scales the single-scattering lobe so that a lobe without
// absorption reflects all light. Turquin 2019, "Practical multiple scattering compensation for microfacet models", eq. 16,
// after Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks".
#ifndef BN_ENERGY_K_H
#define BN_ENERGY_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/records.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/lobe.k.h"

BN_KERNELS_BEGIN

// A place in a table of directional albedo for two widths, with size x size x size/2 x size/2 pairs as in dfg_lookup(). The
// axes, fastest first, are n.v, roughness, the view's azimuth and anisotropy. They are graded to where the albedo bends:
// sqrt(n.v), the lobe's roughness, the square root of the cosine between the wide axis and the view's azimuth, and 1 -
// sqrt(1 - eta).
struct lobe_albedo_place {
    real x, y, z, w; // in entries along these axes
};

// n: the lobe's normal, v: to the eye, both unit, world space.
BN_FN lobe_albedo_place lobe_albedo_place_of(int size, aniso_lobe lobe, real3 n, real3 v)
{
    real one = lit(1.0);
    real last = to_real(int_lit(size - 1));
    real half_last = to_real(int_lit(size / 2 - 1));
    real3 o = to_lobe(lobe, n, v);
    lobe_albedo_place at;
    at.x = sqrt(k_saturate(o.z)) * last;
    at.y = lobe_roughness(lobe) * last;
    real flat2 = o.x * o.x + o.y * o.y;
    real cosine = min(abs(o.x) / sqrt(max(flat2, lit(1e-12))), one);
    at.z = sqrt(cosine) * half_last;
    at.w = (one - sqrt(max(one - lobe_eta(lobe), lit(0.0)))) * half_last;
    return at;
}

// Returns directional albedo from such a table, within 0.02 of the integral for roughness >= 0.1.
BN_FN dfg_value lobe_albedo_lookup(pair_table table, int size, aniso_lobe lobe, real3 n, real3 v)
{
    real one = lit(1.0);
    integer across = int_lit(size);
    integer half_size = int_lit(size / 2);
    lobe_albedo_place at = lobe_albedo_place_of(size, lobe, n, v);
    // Find the cell
    integer ix = min(to_int(at.x), int_lit(size - 2));
    integer iy = min(to_int(at.y), int_lit(size - 2));
    integer iz = min(to_int(at.z), int_lit(size / 2 - 2));
    integer iw = min(to_int(at.w), int_lit(size / 2 - 2));
    real fx = at.x - to_real(ix);
    real fy = at.y - to_real(iy);
    real fz = at.z - to_real(iz);
    real fw = at.w - to_real(iw);
    // Interpolate between azimuths and anisotropies
    dfg_value r;
    r.scale = lit(0.0);
    r.bias = lit(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        integer up_z = int_lit(corner % 2);
        integer up_w = int_lit(corner / 2);
        real part = select(up_z == int_lit(1), fz, one - fz) * select(up_w == int_lit(1), fw, one - fw);
        integer row = (((iw + up_w) * half_size + iz + up_z) * across + iy) * across + ix;
        dfg_value at_corner = dfg_between(table, row, row + across, fx, fy);
        r.scale = r.scale + at_corner.scale * part;
        r.bias = r.bias + at_corner.bias * part;
    }
    return r;
}

// Returns a bilinear value from a slice of a lobe's table: `across` x `across` / 2 pairs as in dfg_lookup(), starting at
// pair `first`. x, z: places along its axes in pairs, not below 0.
BN_FN dfg_value slice_value(pair_table table, int first, int across, real x, real z)
{
    integer ix = min(to_int(x), int_lit(across - 2));
    integer iz = min(to_int(z), int_lit(across / 2 - 2));
    real fx = x - to_real(ix);
    real fz = z - to_real(iz);
    integer row = int_lit(first) + iz * int_lit(across) + ix;
    return dfg_between(table, row, row + int_lit(across), fx, fz);
}

// Returns lobe_albedo_lookup() for a lobe with the widths of its slice, kLobeSliceSize across. The grading of its axes
// takes one division and no root: 1.2 z / (z + .2) for z = n.v, and 3 |x| / (3 |x| + |y|) for the view's components along
// the lobe's wide and narrow axes.
BN_FN dfg_value lobe_slice_lookup(pair_table table, int first, aniso_lobe lobe, real3 n, real3 v)
{
    real3 o = to_lobe(lobe, n, v);
    real up = k_saturate(o.z);
    real wide = abs(o.x) * lit(3.0);
    real from_edge = up + lit(0.2);
    real around = max(wide + abs(o.y), lit(1e-6));
    real inv = lit(1.0) / (from_edge * around);
    real x = up * around * inv * (lit(1.2) * to_real(int_lit(kLobeSliceSize - 1)));
    real z = min(wide * from_edge * inv, lit(1.0)) * to_real(int_lit(kLobeSliceSize / 2 - 1));
    return slice_value(table, first, kLobeSliceSize, x, z);
}

// Returns the same for an Ashikhmin-Shirley lobe. The axes match files of such slices: sqrt(n.v) and the square root of the
// cosine between the wide axis and the view's azimuth.
BN_FN dfg_value phong_slice_lookup(pair_table table, int first, int size, aniso_lobe lobe, real3 n, real3 v)
{
    real3 o = to_lobe(lobe, n, v);
    real x = sqrt(k_saturate(o.z)) * to_real(int_lit(size - 1));
    real flat2 = o.x * o.x + o.y * o.y;
    real cosine = min(abs(o.x) / sqrt(max(flat2, lit(1e-12))), lit(1.0));
    real z = sqrt(cosine) * to_real(int_lit(size / 2 - 1));
    return slice_value(table, first, size, x, z);
}

// Returns a factor on the specular lobe. f0: reflectance at normal incidence, [0,1]. albedo: directional, without
// absorption, (0,1]; an estimate above 1 gives a factor below 1. Albedos below 0.05 count as 0.05.
BN_FN real3 energy_compensation_of_albedo(real3 f0, real albedo)
{
    real lost = lit(1.0) / max(albedo, lit(0.05)) - lit(1.0);
    return vec3_all(lit(1.0)) + f0 * lost;
}

// Returns a factor on the specular lobe, at least 1.
BN_FN real3 energy_compensation(real3 f0, dfg_value dfg)
{
    return energy_compensation_of_albedo(f0, min(dfg.scale + dfg.bias, lit(1.0)));
}

BN_KERNELS_END
#endif
