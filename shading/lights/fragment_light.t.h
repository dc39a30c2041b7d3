// All light that a fragment gives off towards the eye: what is made of a material's inputs at a visible point.
#ifndef BN_FRAGMENT_LIGHT_T_H
#define BN_FRAGMENT_LIGHT_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/lang/techniques.h"
#include "shading/lights/area.t.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/key.t.h"
#include "shading/lights/punctual.t.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/shared_line.k.h"

BN_KERNELS_BEGIN

// lobe: that lights meet, its place in shading/models.def.
BN_STAGE real3 light_of_sky(any_frame f, BN_IN(shaded_point) x, int lobe)
{
    return light_from_key_lights(f, x, lobe);
}

BN_STAGE real3 light_of_lamps(any_frame f, BN_IN(shaded_point) x, int lobe, BN_IN(real3) position)
{
    return light_from_punctual(f, x, lobe, position);
}

BN_STAGE real3 light_of_area_lights(any_frame f, BN_IN(shaded_point) x, int lobe, BN_IN(real3) position)
{
    return light_from_area(f, x, lobe, position);
}

// shape: lobe_shape_at(f, m, at, p). px, py: pixel. shares: the technique shares samples, and fragments meet their neighbours; the colour
// is then made of what they all found (line_mean).
BN_FN line_record light_of_fragment(frame_ref f, material_ref m, technique_ref t, BN_IN(material_inputs) at, BN_IN(lobe_shape) shape,
                                    BN_IN(visible_point) p, integer px, integer py, bool shares)
{
    real3 light = own_light(m, at);
    if (the_material(m).unlit != 0)
        return line_alone(light);
    shaded_point x;
    make_shaded_point(f, m, at, shape, p, py * int_lit(the_frame(f).width) + px, x);
    int traits = technique_traits(m, t);
    if (!shares)
        light = environment_light(f, x, traits, technique_specular(f, t, x)) + light;
    if (the_frame(f).key_light_count > 0)
        light = light + light_of_sky(f, x, the_material(m).lights_lobe);
    if (the_frame(f).light_count > 0)
        light = light + light_of_lamps(f, x, the_material(m).lights_lobe, p.position);
    if (the_frame(f).area_light_count > 0)
        light = light + light_of_area_lights(f, x, the_material(m).lights_lobe, p.position);
    if (shares)
        return shared_light(f, x, traits, technique_shared(f, t, x, quad_offset(px & int_lit(1), py & int_lit(1))), light);
    return line_alone(light);
}

BN_KERNELS_END

#endif
