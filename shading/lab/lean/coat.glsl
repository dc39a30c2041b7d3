// A clear coat as an engine has it: an isotropic GGX lobe about its own normal, over the surface. Environment light comes from one
// prefiltered fetch. Schlick's reflectance at the view cosine is the coat's share of all light; the surface below has the rest.
// KHR_materials_clearcoat; Karis 2013, "Real Shading in Unreal Engine 4".
#ifndef BN_LEAN_COAT_GLSL
#define BN_LEAN_COAT_GLSL

#include "shading/lab/lean/surface.glsl"
#include "shading/lab/lean/techniques.glsl"

struct Coat {
    Axes axes; // about the coat's normal
    float share; // of all light, which the coat takes from the surface below
    float roughness, n_dot_v;
};

// Makes the coat. v: to the eye.
Coat coat_of(Axes geometry, vec3 v)
{
    Coat c;
    // Apply the coat's own normal map
    c.axes = geometry;
    if (textured(kCoatNormalTex))
        c.axes = mapped_axes(geometry, fetch(textures[kCoatNormalTex], kCoatNormalTex).xyz, material.coat.w);
    // Evaluate factor and roughness
    float factor = material.coat.x;
    if (textured(kCoatTex))
        factor *= fetch(textures[kCoatTex], kCoatTex).x;
    c.roughness = material.coat.y;
    if (textured(kCoatRoughnessTex))
        c.roughness *= fetch(textures[kCoatRoughnessTex], kCoatRoughnessTex).y;
    // Find the share of light
    float cosine = dot(c.axes.n, v), away = 1.0 - clamp(cosine, 0.0, 1.0), away2 = away * away;
    c.share = factor * mix(material.coat.z, 1.0, away2 * away2 * away);
    c.n_dot_v = clamp(cosine, 1e-4, 1.0);
    return c;
}

// Returns the reflected environment light, before the environment's scale.
vec3 environment_on_coat(Coat c, vec3 v)
{
    vec2 dfg = textureLod(round_albedo, vec2(c.n_dot_v, c.roughness) * frame.tables.x + frame.tables.y, 0.0).xy;
    return specular_at(reflect(-v, c.axes.n), c.roughness * frame.scale.w) * (c.share * (dfg.x + dfg.y));
}

// Returns the length of a direction with the lobe's widths as units, for Smith's masking. cosine: of the direction; alpha2: squared width.
float coat_stretch(float cosine, float alpha2) { return sqrt(cosine * cosine * (1.0 - alpha2) + alpha2); }

// Returns the coat's BRDF for light from l. cosine: of l, above 0; alpha2: squared width; of_eye: coat_stretch() of the eye.
float coat_brdf(Coat c, vec3 v, vec3 l, float cosine, float alpha2, float of_eye)
{
    vec3 h = normalize(l + v), across = cross(c.axes.n, h); // whose length keeps digits near the peak
    float up = dot(c.axes.n, h), spread = dot(across, across) / alpha2 + up * up;
    float masking = 0.5 / max(cosine * of_eye + c.n_dot_v * coat_stretch(cosine, alpha2), 1e-12);
    return c.share * masking / (3.14159265 * alpha2 * spread * spread);
}

#endif
