// Shading of one visible (pixel, triangle) pair, by the assembly of shading/.
#ifndef BN_SHADE_GLSL
#define BN_SHADE_GLSL

#include "shading/stages/backdrop.glsl"
#include "shading/stages/fragment.glsl"
#include "shading/stages/techniques.glsl"
#include "shading/lights/environment.t.h"
#include "shading/lights/key.t.h"
#include "shading/lights/punctual.t.h"
#include "shading/surface/shaded_point.t.h"

real3 shade_point(int m, material_inputs at, visible_point p, int pixel_id)
{
    if (materials[m].unlit != 0)
        return at.base;
    shaded_point x;
    make_shaded_point(0, m, at, lobe_shape_of(0, m, at), p, pixel_id, x);
    int traits = materials[m].technique_traits;
    real3 specular = technique_specular(0, materials[m].technique, x);
    real3 color = environment_light(0, x, traits, specular) + at.emissive;
    if (frame.key_light_count > 0)
        color = color + light_from_key_lights(0, x, materials[m].lights_lobe);
    if (frame.light_count > 0)
        color = color + light_from_punctual(0, x, materials[m].lights_lobe, p.position);
    return color;
}

// Of a material that shares samples.
line_record shade_line(int m, material_inputs at, visible_point p, int px, int py)
{
    shaded_point x;
    make_shaded_point(0, m, at, lobe_shape_of(0, m, at), p, py * frame.width + px, x);
    int traits = materials[m].technique_traits;
    real3 more = at.emissive;
    if (frame.key_light_count > 0)
        more = more + light_from_key_lights(0, x, materials[m].lights_lobe);
    if (frame.light_count > 0)
        more = more + light_from_punctual(0, x, materials[m].lights_lobe, p.position);
    return shared_light(0, x, traits, technique_shared(0, materials[m].technique, x, quad_offset(px & 1, py & 1)), more);
}

#endif
