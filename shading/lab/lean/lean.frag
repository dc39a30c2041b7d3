// Shades a fragment under the environment and the lights as an engine does: see frame.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shading/lab/lean/surface.glsl"
#include "shading/lab/lean/techniques.glsl"
#include "shading/lab/lean/coat.glsl"
#include "shading/lab/lean/lights.glsl"

layout(location = 0) out vec4 radiance;

vec3 specular_of(Surface s)
{
    switch (kTechnique) {
    case 0: return split_isotropic(s);
    case 1: return bent_normal(s);
    case 2: return major_axis(s);
    case 3: return major_axis_adaptive(s);
    case 4: return major_axis_weighted(s);
    case 5: return lobe_line(s);
    case 6: return filtered_is(s, false);
    case 7: return filtered_is(s, true);
    case 8: return mc(s);
    default: return as_mc(s);
    }
}

void main()
{
    // Evaluate base colour and the alpha test
    vec4 base = material.base;
    if (textured(kBaseColorTex))
        base *= fetch(textures[kBaseColorTex], kBaseColorTex);
    if (has(kVertexColors))
        base *= color;
    if (has(kAlphaTest) && base.a < material.diffuse.w)
        discard;
    if (has(kUnlit)) {
        radiance = vec4(base.rgb, 1.0);
        return;
    }
    // Add the specular and the diffuse environment light
    Axes geometry = geometric_axes();
    Surface s = surface_of(base, geometry);
    vec3 light = specular_of(s) * frame.scale.x;
    if (has(kDiffuse))
        light += s.diffuse * (diffuse_share(s) * frame.scale.y) * textureLod(cubes[1], s.n, 0.0).rgb;
    light *= s.occlusion;
    // Make the coat, under the same occlusion
    Coat coat = Coat(geometry, 0.0, 0.0, 1.0);
    vec3 gloss = vec3(0.0);
    if (has(kCoat)) {
        coat = coat_of(geometry, s.v);
        gloss = environment_on_coat(coat, s.v) * (frame.scale.x * s.occlusion);
    }
    // Add lights and emission
    if (has(kLamps))
        light += light_of_lamps(s, coat, gloss);
    if (has(kAreas))
        light += light_of_areas(s, coat, gloss);
    if (has(kEmits))
        light += s.emissive;
    // Put the coat over it
    if (has(kCoat))
        light = light * (1.0 - coat.share) + gloss;
    radiance = vec4(light, 1.0);
}
