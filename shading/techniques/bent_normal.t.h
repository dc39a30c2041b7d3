// The bent normal technique, one fetch: see bent_normal.k.h.
#ifndef BN_BENT_NORMAL_T_H
#define BN_BENT_NORMAL_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/techniques/bent_normal.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

BN_FN real3 bent_normal_specular(frame_ref f, BN_IN(shaded_point) x)
{
    cube_desc cube = prefiltered_env(f);
    bent_ray ray = BN_MUTANT(gltf_bend, bent_normal_ray(x.s.n, x.s.v, x.lobe), gltf_bent_ray(x.s.n, x.s.v, x.lobe));
    real lod = ray.lod * to_real(int_lit(cube.levels - 1));
    return cube_sample(cube, ray.direction, lod) * BN_MUTANT(gltf_bend, x.energy.albedo, gltf_albedo(f, x));
}

BN_KERNELS_END

#endif
