// The bent normal that the specification of KHR_materials_anisotropy recommends, which glTF viewers use.
#ifndef BN_GLTF_BENT_NORMAL_T_H
#define BN_GLTF_BENT_NORMAL_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/reflectance.t.h"
#include "shading/techniques/bent_normal.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

// Returns the material's roughness: the roughness along the lobe's narrow axis.
BN_FN real gltf_roughness(aniso_lobe lobe)
{
    real across = min(lobe.sigma_v * lit(1.4142135623730951), lit(1.0));
    return sqrt(across);
}

// Returns the albedo that viewers take: a round lobe's albedo at the material's roughness.
BN_FN real3 gltf_albedo(frame_ref f, BN_IN(shaded_point) x)
{
    return albedo_of(x.s, dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, x.s.n_dot_v, gltf_roughness(x.lobe)));
}

// Returns direction and level as bent_normal_ray() does. The material's roughness and strength follow from the lobe's widths.
BN_FN bent_ray gltf_bent_ray(real3 n, real3 v, aniso_lobe lobe)
{
    // Find roughness and strength
    real along = min(lobe.sigma_u * lit(1.4142135623730951), lit(1.0));
    real across = min(lobe.sigma_v * lit(1.4142135623730951), lit(1.0));
    real roughness = gltf_roughness(lobe);
    real strength = sqrt(max(along - across, lit(0.0)) / max(lit(1.0) - across, lit(1e-4)));
    // Bend the normal
    real3 grain = BN_MUTANT(bend_across, lobe.v_axis, lobe.u_axis);
    real3 plane = v - grain * k_dot3(v, grain);
    real3 turned = plane / max(sqrt(k_dot3(plane, plane)), lit(1e-4));
    real factor = lit(1.0) - strength * (lit(1.0) - roughness);
    real squared = factor * factor;
    real kept = BN_MUTANT(bend_factor, squared * squared, k_exp2(k_exp2(factor)));
    kept = BN_MUTANT(no_bend, kept, lit(1.0));
    kept = BN_MUTANT(mean_width, kept, lit(1.0));
    real3 mixed = turned * (lit(1.0) - kept) + n * kept;
    real3 bent = k_normalize3(mixed);
    // Mirror the view
    bent_ray r;
    r.direction = bent * (lit(2.0) * k_dot3(bent, v)) - v;
    r.lod = BN_MUTANT(mean_width, roughness, lobe_roughness(lobe));
    return r;
}

BN_KERNELS_END

#endif
