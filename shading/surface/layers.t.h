// Layers of a picture at a visible point (shading/layers.def), and their consecutive words.
#ifndef BN_LAYERS_T_H
#define BN_LAYERS_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/texture_place.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/recorded.t.h"
#include "shading/surface/specular_aa.t.h"

BN_KERNELS_BEGIN

struct layer_values {
#define BN_LAYER(type, words, name, channels) type name;
#include "shading/layers.def"
};

// Returns the fractional level at which the normal map is read, else the first texture; -1 without textures.
BN_STAGE real lod_at(any_frame f, material_ref m, BN_IN(visible_point) p)
{
    // Pick the normal map, else the first texture in use
    int slot = -1;
    for (int i = 0; i < kTextureSlots; ++i) {
        if (slot < 0 && texture_used(m, i))
            slot = i;
    }
    if (texture_used(m, kNormalTex))
        slot = kNormalTex;
    // Find its level
    real level = lit(-1.0);
    if (slot >= 0) {
        texture_place place = texture_place_of(the_material(m).textures[slot], p);
        level = texture_footprint_of(texture_desc_of(f, m, slot), place.dx, place.dy, the_frame(f).texture_taps).lod;
    }
    return level;
}

// Returns the layer values. p needs its position, too.
BN_STAGE layer_values layers_of(any_frame f, material_ref m, BN_IN(material_inputs) at, BN_IN(visible_point) p)
{
    // Find the lobe on the surface
    lobe_shape shape = lobe_shape_at(f, m, at, p);
    surface_frame axes = lobe_axes(f, m, at, facing_geometric_axes(p), facing_handedness(p));
    aniso_lobe lobe = lobe_in_frame(m, shape, axes);
    layer_values r;
    // Fill the layers
    real3 from_eye = p.position - splat3(the_frame(f).view.eye);
    real3 forward = splat3(the_frame(f).view.forward);
    r.depth = k_dot3(from_eye, forward);
    r.normal = axes.n;
    r.albedo = at.base;
    r.roughness = min(max(shape.roughness, lit(0.0)), lit(1.0));
    r.tangent = lobe.u_axis;
    r.anisotropy = lobe_eta(lobe);
    r.metalness = k_saturate(at.metallic);
    r.lod = lod_at(f, m, p);
    return r;
}

BN_FN void record_layers(BN_INOUT(recorder) w, BN_IN(layer_values) v)
{
#define BN_LAYER(type, words, name, channels) put_##type(w, v.name);
#include "shading/layers.def"
}

BN_KERNELS_END

#endif
