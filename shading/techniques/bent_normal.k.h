// Bent normal: one prefiltered sample in the direction mirrored about a normal bent away from the grain. Lagarde and
// Golubev 2018, "The Road Toward Unified Rendering with Unity's High Definition Render Pipeline" (Cocco et al. 2024, sec.
// 4).
#ifndef BN_BENT_NORMAL_K_H
#define BN_BENT_NORMAL_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/lobe.k.h"

BN_KERNELS_BEGIN

struct bent_ray {
    real3 direction; // any length
    real lod;        // [0,1], times the last level
};

// Returns the direction and level. n: shading normal, v: to the eye, both unit, world space.
BN_FN bent_ray bent_normal_ray(real3 n, real3 v, aniso_lobe lobe)
{
    real al = lobe_roughness(lobe);
    real eta = abs(lobe_eta(lobe));
    real stretch = eta * min(lit(1.5) * sqrt(al), lit(1.0));
    stretch = min(stretch, lit(0.999)); // a view along the grain would leave no direction
    real3 grain = lobe.v_axis;
    real3 across = v - grain * k_dot3(v, grain);
    real3 bent = n * (lit(1.0) - stretch) + across * stretch; // neither the bent normal nor its mirror is unit
    bent_ray r;
    r.direction = bent * (lit(2.0) * k_dot3(bent, v)) - v * k_dot3(bent, bent);
    r.lod = al * min(max(lit(1.2) - eta, lit(0.0)), lit(1.0));
    return r;
}

BN_KERNELS_END

#endif
