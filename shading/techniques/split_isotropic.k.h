// Isotropic split integral: prefiltered radiance in the mirror direction times directional albedo. Karis 2013, "Real
// Shading in Unreal Engine 4".
#ifndef BN_SPLIT_ISOTROPIC_K_H
#define BN_SPLIT_ISOTROPIC_K_H

#include "shading/kernels/cube_filter.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Returns the prefiltered radiance over the lobe; multiply by its directional albedo.
BN_FN real3 split_isotropic_radiance(surface s, cube_desc environment)
{
    real3 r = s.n * (lit(2.0) * k_dot3(s.n, s.v)) - s.v;
    real lod = s.roughness * to_real(int_lit(environment.levels - 1));
    return cube_sample(environment, r, lod);
}

BN_KERNELS_END

#endif
