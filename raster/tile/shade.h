// Shading of visible fragments, kLanes at a time, all of one material: interpolate, fetch textures, run the assembly of shading/.
#pragma once
#include "raster/tile/fragment.h"
#include "raster/tile/techniques.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/key.t.h"
#include "shading/lights/punctual.t.h"
#include "shading/surface/shaded_point.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// What is the same for all fragments of a material, found once.
struct MaterialPlan {
    bool uniform;       // nothing changes from fragment to fragment
    material_inputs at; // then
    bool one_shape;     // no texture changes the lobe's shape
    lobe_shape shape;   // then
};

BN_INLINE MaterialPlan plan_material(frame_ref f, material_ref m)
{
    MaterialPlan plan;
    plan.one_shape = one_lobe_shape(m);
    plan.uniform = !m.textured && !m.uses_color;
    if (plan.uniform)
        plan.at = fetch_lanes(f, m, visible_point{});
    if (plan.one_shape)
        plan.shape = only_lobe_shape(f, m);
    return plan;
}

[[maybe_unused]] BN_STAGE real3 light_of_sky(const ShadingFrame& f, const shaded_point& x, int lobe)
{
    return light_from_key_lights(f, x, lobe);
}

[[maybe_unused]] BN_STAGE real3 light_of_lamps(const ShadingFrame& f, const shaded_point& x, int lobe, const real3& position)
{
    return light_from_punctual(f, x, lobe, position);
}

// x, y: pixels. Of a technique that shares samples the colour is made of `shared`, later.
template <Technique kTechnique>
BN_INLINE real3 shade_fragments(frame_ref f, material_ref m, const MaterialPlan& plan, const visible_point& p, integer x, integer y,
                                [[maybe_unused]] line_record& shared)
{
    constexpr int kTraits = kTechniqueTraits[static_cast<int>(kTechnique)];
    material_inputs fetched;
    if (!plan.uniform)
        fetched = fetch_lanes(f, m, p);
    const material_inputs& at = plan.uniform ? plan.at : fetched;
    if (m.unlit) {
        shared = line_record{};
        return at.base;
    }
    const lobe_shape shape = plan.one_shape ? plan.shape : lobe_shape_of(f, m, at);
    shaded_point point;
    make_shaded_point(f, m, at, shape, p, y * int_lit(f.width) + x, point);
    real3 color = at.emissive;
    if constexpr ((kTraits & kSharesSamples) == 0) {
        const real3 specular = technique_specular<kTechnique>(f, point);
        color = environment_light(f, point, kTraits, specular) + color;
    }
    if (f.key_light_count > 0)
        color = color + light_of_sky(f, point, m.lights_lobe);
    if (f.light_count > 0)
        color = color + light_of_lamps(f, point, m.lights_lobe, p.position);
    if constexpr ((kTraits & kSharesSamples) != 0)
        shared =
            shared_light(f, point, kTraits, technique_shared<kTechnique>(f, point, quad_offset(x & int_lit(1), y & int_lit(1))), color);
    return color;
}

} // namespace BN_ISA_NS
} // namespace burnish
