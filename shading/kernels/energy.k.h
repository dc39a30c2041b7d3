// Light scattered more than once between microfacets, returned to the lobe: the single-scattering lobe scaled so that
// it reflects all light where it absorbs none. Turquin 2019, "Practical multiple scattering compensation for
// microfacet models", eq. 16 (after Kulla, Conty 2017).
#ifndef BN_ENERGY_K_H
#define BN_ENERGY_K_H
#include "shading/kernels/dfg.k.h"
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Factor of at least 1 on the specular lobe. f0: reflectance at normal incidence, [0,1]; scale + bias is the directional
// albedo of a lobe that absorbs nothing, (0,1].
BN_FN real3 energy_compensation(real3 f0, dfg_value dfg)
{
    real albedo = min(max(dfg.scale + dfg.bias, lit(0.05)), lit(1.0));
    real lost = lit(1.0) / albedo - lit(1.0);
    return vec3_all(lit(1.0)) + f0 * lost;
}

BN_KERNELS_END
#endif
