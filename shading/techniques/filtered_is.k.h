// Filtered importance sampling: an n x n grid of samples, each fetched from the box-filtered environment at the level whose
// texels match the sample's share of the sphere. Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance
// Sampling".
#ifndef BN_FILTERED_IS_K_H
#define BN_FILTERED_IS_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/models/beckmann.k.h"
#include "shading/models/ggx_aniso.k.h"

BN_KERNELS_BEGIN

struct filtered_sample {
    real3 wi;     // unit
    real weight;  // f cos / pdf without Fresnel; 0 where the sample is invalid
    real o_dot_h; // for Fresnel
    real lod;     // level of the box chain, not clamped above
};

// Makes a sample; its slopes are (slope_x, slope_y) of the unit lobe times the widths. wo: unit, wo.z > 0. density: of the
// unit lobe's normals, times h.z^4, which equals D h.z^4 alpha_x alpha_y. texel_term: log2(6 w^2 / (4 pi n^2)) / 2 for
// faces with w^2 texels and n^2 samples. The caller multiplies the weight by its visibility, G2 / (4 wo.z wi.z) at wi.
BN_FN filtered_sample filtered_is_place(real3 wo, real alpha_x, real alpha_y, real slope_x, real slope_y, real density, real texel_term)
{
    real3 h = k_normalize3(vec3_of(-alpha_x * slope_x, -alpha_y * slope_y, lit(1.0)));
    filtered_sample s;
    s.wi = mirror_direction(wo, h);
    s.o_dot_h = k_dot3(wo, h);
    mask valid = both(s.o_dot_h > lit(0.0), s.wi.z > lit(0.0));
    real oh = max(s.o_dot_h, lit(1e-8));
    real hz2 = h.z * h.z;
    real pdf = density / (alpha_x * alpha_y * hz2 * h.z * oh * lit(4.0)); // D h.z / (4 wo.h)
    s.lod = max(texel_term - lit(0.5) * k_log2(max(pdf, lit(1e-30))), lit(0.0));
    // f cos / pdf = visibility * 4 wi.z oh / h.z; the caller multiplies by its visibility
    s.weight = select(valid, lit(4.0) * s.wi.z * oh / h.z, lit(0.0));
    return s;
}

BN_FN filtered_sample filtered_is_beckmann(real3 wo, beckmann_params p, real slope_x, real slope_y, real density, real texel_term)
{
    filtered_sample s = filtered_is_place(wo, p.alpha_x, p.alpha_y, slope_x, slope_y, density, texel_term);
    s.weight = s.weight * lit(0.25) * beckmann_visibility(p, wo, vec3_of(s.wi.x, s.wi.y, max(s.wi.z, lit(1e-8))));
    return s;
}

BN_FN filtered_sample filtered_is_ggx(real3 wo, ggx_aniso_params p, real slope_x, real slope_y, real density, real texel_term)
{
    filtered_sample s = filtered_is_place(wo, p.alpha_x, p.alpha_y, slope_x, slope_y, density, texel_term);
    s.weight = s.weight * ggx_aniso_visibility(p, wo, vec3_of(s.wi.x, s.wi.y, max(s.wi.z, lit(1e-8))));
    return s;
}

BN_KERNELS_END

#endif
