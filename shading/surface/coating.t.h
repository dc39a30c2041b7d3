// A coating: a layer above a material's own lobe, with a lobe and a normal of its own. shading/coatings.def lists them.
#ifndef BN_COATING_T_H
#define BN_COATING_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// The coatings' functions <id>_coating(f, m, at, axes, v, handedness) return this record. axes: the geometry's, facing the
// eye; v: to the eye, unit, world space; handedness: facing_handedness().
struct coating {
    surface_frame axes;       // about the coating's normal
    real3 horizon;            // normal of the horizon; light from below it is not reflected
    bool has_surface_horizon; // that is the geometry's horizon, and the normal may differ from the geometry's
    real3 reflectance;        // factor on the coating's lobe, [0,1]
    real share;               // of all light that the coating reflects, [0,1]; the layers below have 1 - share
    real roughness;           // perceptual, [0,1]
};

// Returns the clamped cosine between the coating's normal and the eye.
BN_FN real coating_n_dot_v(BN_IN(coating) layer, real3 v)
{
    return min(max(k_dot3(layer.axes.n, v), lit(1e-4)), lit(1.0));
}

// Returns the directional albedo of a round GGX lobe, for coatings that have one.
BN_FN dfg_value ggx_coating_albedo(frame_ref f, BN_IN(coating) layer, real n_dot_v)
{
    if (the_frame(f).dfg_fit != 0)
        return dfg_fit(n_dot_v, layer.roughness);
    return dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, n_dot_v, layer.roughness);
}

// Returns true where a material has the coating `at` in some place.
BN_FN bool has_coating(material_ref m, int at)
{
    return (the_material(m).coatings >> at & 1) != 0;
}

BN_KERNELS_END

#endif
