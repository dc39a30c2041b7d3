// Shades visible fragments with one material, kLanes at a time: interpolates, fetches textures, runs the assembly of shading/.
#pragma once
#include <cstddef>
#include <new>

#include "raster/tile/fragment.h"
#include "shading/lights/fragment_light.t.h"
#include "shading/surface/specular_aa.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Values that are equal for all fragments with a material, computed once.
struct MaterialPlan {
    bool untextured;    // no input changes between fragments, except by vertex colours
    material_inputs at; // the inputs, if untextured; colour_inputs() applies vertex colours
    bool one_shape;     // no texture changes the lobe's shape, or nothing needs the shape
    lobe_shape shape;   // the shape, if there is one
};

BN_INLINE MaterialPlan plan_material(frame_ref f, material_ref m)
{
    MaterialPlan plan;
    plan.one_shape = m.unlit || (one_lobe_shape(m) && !f.specular_aa);
    plan.untextured = !m.textured;
    if (plan.untextured)
        plan.at = fetch_lanes(f, m, visible_point{});
    if (plan.one_shape)
        plan.shape = only_lobe_shape(f, m);
    return plan;
}

// Computes the light of fragments. x, y: pixels.
template <Technique kTechnique>
BN_INLINE shared_sample_record shade_fragments(frame_ref f, material_ref m, const material_inputs& at, const lobe_shape& shape,
                                               const visible_point& p, integer x, integer y)
{
    using Tag = technique_tag<kTechnique>;
    const bool alone = (Tag::kTraits & kRoundAlone) != 0 && m.anisotropic == 0;
    return light_of_fragment(f, m, Tag{}, at, shape, p, x, y, (Tag::kTraits & kSharesSamples) != 0 && !alone);
}

template <Technique kTechnique>
BN_INLINE shared_sample_record shade_planned(frame_ref f, material_ref m, const MaterialPlan& plan, const visible_point& p, integer x,
                                             integer y)
{
    alignas(material_inputs) std::byte fetched[sizeof(material_inputs)]; // large, so constructed in place
    const bool uniform = plan.untextured && !m.uses_color;
    const material_inputs& at = uniform ? plan.at : *::new (fetched) material_inputs(fetch_lanes(f, m, p));
    const lobe_shape shape = plan.one_shape ? plan.shape : lobe_shape_at(f, m, at, p);
    return shade_fragments<kTechnique>(f, m, at, shape, p, x, y);
}

} // namespace BN_ISA_NS
} // namespace burnish
