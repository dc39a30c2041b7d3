// The isotropic split integral: see split_isotropic.k.h.
#ifndef BN_SPLIT_ISOTROPIC_T_H
#define BN_SPLIT_ISOTROPIC_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/techniques/split_isotropic.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

BN_FN real3 split_isotropic_specular(frame_ref f, BN_IN(shaded_point) x)
{
    return split_isotropic_radiance(x.s, prefiltered_env(f)) * x.energy.albedo;
}

BN_KERNELS_END

#endif
