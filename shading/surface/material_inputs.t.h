// The values of a material at a visible point, for lobes and coatings. shading/material.def lists them.
#ifndef BN_MATERIAL_INPUTS_T_H
#define BN_MATERIAL_INPUTS_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct material_inputs {
#define BN_INPUT(type, words, name) type name;
#include "shading/material.def"
};

BN_FN real3 rgb_of(real4 t)
{
    return vec3_of(t.x, t.y, t.z);
}

// Decodes a texel to a normal in tangent space, any length.
BN_FN real3 scaled_normal(real4 texel, real scale)
{
    real3 n = rgb_of(texel) * lit(2.0) - vec3_all(lit(1.0));
    return vec3_of(n.x * scale, n.y * scale, n.z);
}

BN_KERNELS_END

#endif
