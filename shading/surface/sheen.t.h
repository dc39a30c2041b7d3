// Sheen, by KHR_materials_sheen: a layer of fibres with the Charlie lobe about the surface's normal. The layers below have the
// light that its lobe leaves, by its brightest colour channel.
#ifndef BN_SHEEN_T_H
#define BN_SHEEN_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/models/charlie.k.h"
#include "shading/surface/coating.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/frame_by_map.t.h"
#include "shading/surface/material_inputs.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Multiplies the layer's factors by its textures.
BN_FN void sheen_inputs(material_ref m, BN_IN(texture_fetches) t, BN_INOUT(material_inputs) r)
{
    r.sheen_color = vec3_all(lit(0.0));
    r.sheen_roughness = lit(0.0);
    if (!has_coating(m, kCoating_sheen))
        return;
    r.sheen_color = splat3(the_material(m).sheen_color);
    if (texture_used(m, kSheenColorTex))
        r.sheen_color = r.sheen_color * rgb_of(texel_of(t, kSheenColorTex));
    r.sheen_roughness = splat(the_material(m).sheen_roughness);
    if (texture_used(m, kSheenRoughnessTex))
        r.sheen_roughness = r.sheen_roughness * texel_of(t, kSheenRoughnessTex).w;
}

// Returns the directional albedo of the layer's lobe.
BN_FN dfg_value sheen_albedo(frame_ref, BN_IN(coating) layer, real n_dot_v)
{
    dfg_value r;
    r.scale = charlie_albedo(n_dot_v, layer.roughness);
    r.bias = lit(0.0);
    return r;
}

// Returns the layer; the parameters are explained in coating.t.h.
BN_FN coating sheen_coating(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(surface_frame) axes, real3 v, real handedness)
{
    coating c;
    // Find the normal and the horizon
    bool mapped = texture_used(m, kNormalTex);
    c.axes = axes;
    if (mapped)
        c.axes = frame_by_map(m, axes, at.normal_map, handedness);
    c.has_surface_horizon = mapped && the_frame(f).horizon != 0;
    c.horizon = c.axes.n;
    if (the_frame(f).horizon != 0)
        c.horizon = axes.n;
    // Find the light that it reflects; the lobe has a least width
    c.reflectance = min(max(at.sheen_color, vec3_all(lit(0.0))), vec3_all(lit(1.0)));
    c.roughness = min(max(at.sheen_roughness, lit(0.1)), lit(1.0));
    real brightest = max(max(c.reflectance.x, c.reflectance.y), c.reflectance.z);
    c.share = brightest * charlie_albedo(coating_n_dot_v(c, v), c.roughness);
    return c;
}

BN_KERNELS_END

#endif
