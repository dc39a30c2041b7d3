// The surface at a fragment: from interpolated attributes, material constants and textures.
#ifndef BN_LEAN_SURFACE_GLSL
#define BN_LEAN_SURFACE_GLSL

#include "shading/lab/lean/frame.glsl"

layout(constant_id = 0) const int kTechnique = 0; // index in kLeanTechniques (raster/vulkan/lab/lean.cpp)
layout(constant_id = 1) const int kSamples = 1; // as many as the technique takes
layout(constant_id = 2) const int kTextures = 0; // a bit per used slot (core/scene/material.def)
layout(constant_id = 3) const int kTraits = 0; // the material's traits, see below

const int kAnisotropic = 1, kDiffuse = 2, kOneShape = 4, kVertexColors = 8, kTwoSided = 16, kAlphaTest = 32,
          kUnlit = 64, kMirror = 128, kEmits = 256, kOneEta = 512, kFactorRoughness = 1024, kPhongTable = 2048, kLamps = 4096,
          kAreas = 8192, kRoundLights = 16384, kCoat = 32768;
const int kBaseColorTex = 0, kMetalRoughTex = 1, kNormalTex = 2, kOcclusionTex = 3, kEmissiveTex = 4, kTensor2Tex = 7, kTensor4Tex = 8,
          kCoatTex = 12, kCoatRoughnessTex = 13, kCoatNormalTex = 14;
const int kTextureSlots = 0
#define BN_SLOT(slot, at, texture, encoding, power) +1
#include "core/scene/material.def"
    ;

bool has(int trait) { return (kTraits & trait) != 0; }
bool textured(int slot) { return (kTextures >> slot & 1) != 0; }

layout(std140, set = 0, binding = 1) uniform LeanMaterial
{
    vec4 base; // colour, alpha
    vec4 dielectric; // reflectance at normal and at grazing incidence
    vec4 f0; // both parts mixed, at normal and at grazing incidence; without colour or metalness textures
    vec4 diffuse; // albedo of the diffuse part, likewise; w: alpha cutoff
    vec4 factors; // metallic, roughness, normal scale, occlusion strength
    vec4 emissive;
    vec4 lobe; // slope deviations along and across, roughness, eta or anisotropy strength
    vec4 grain; // the axis along tangent and bitangent, or a texture's rotation; bent normal's stretch and level
    vec4 place[2 * kTextureSlots]; // by slot: linear part of the coordinate transform; shift, most taps, set
    vec4 coat; // of a clear coat: factor, roughness, reflectance at normal incidence, normal scale
}
material;

layout(set = 0, binding = 3) uniform sampler2D round_albedo; // n.v, roughness
layout(set = 0, binding = 4) uniform sampler2D slice_albedo; // for the material's two widths: see lobe_slice_lookup (energy.k.h)
layout(set = 0, binding = 5) uniform sampler3D width_albedo; // for any two widths: slabs of eta
layout(set = 0, binding = 6) uniform sampler2D phong_albedo; // for the material's two widths, Ashikhmin-Shirley lobe
layout(set = 1, binding = 0) uniform samplerCube cubes[4]; // specular, irradiance, box, the whole sky
layout(set = 1, binding = 1) uniform sampler2D textures[kTextureSlots]; // by slot

// Interpolated at pixel centres, not at centroids: cheaper, and nearer to the tile renderer's shading positions.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 color;

struct Axes {
    vec3 n, t, b; // orthonormal
    float hand; // b is hand * cross(n, t)
};

struct Surface {
    vec3 n, v, u_axis, v_axis; // unit; along the grain and across
    vec3 o; // v in the frame of u_axis, v_axis and n, above the horizon
    vec2 sigma; // slope deviations, the greater one first
    float roughness, stretch, bent_level;
    float n_dot_v;
    vec3 f0, diffuse, dielectric_f0;
    float f90, dielectric_f90;
    vec2 dfg;
    vec3 albedo;
    vec3 emissive;
    float occlusion;
};

// Returns a slot's filtered value: trilinear taps along the footprint's longer axis, as many as its length asks for.
vec4 fetch(sampler2D image, int slot)
{
    // Transform the texture coordinates
    vec4 m = material.place[2 * slot], shift = material.place[2 * slot + 1];
    vec2 from = shift.w != 0.0 ? uv.zw : uv.xy;
    vec2 at = vec2(m.x * from.x + m.z * from.y, m.y * from.x + m.w * from.y) + shift.xy;
    // Find the footprint's level and number of taps
    vec2 dx = dFdx(at), dy = dFdy(at), size = vec2(textureSize(image, 0));
    float x2 = dot(dx * size, dx * size), y2 = dot(dy * size, dy * size);
    float longer = sqrt(max(x2, y2)), shorter = sqrt(min(x2, y2));
    float part = clamp(longer / max(shorter, 1e-7), 1.0, shift.z);
    float lod = max(log2(longer / part), 0.0);
    int taps = int(ceil(min(part, max(longer, 1.0)) - 0.004));
    if (taps <= 1)
        return textureLod(image, at, lod);
    // Average the taps along the longer axis
    vec2 along = (x2 >= y2 ? dx : dy) / float(taps + 1);
    at -= along * (0.5 * float(taps + 1));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        at += along;
        sum += textureLod(image, at, lod);
    }
    return sum / float(taps);
}

// Computes lobe widths and axis from direction textures: slope deviations along the eigenvectors of their covariance.
void shape_by_texture(float roughness, out vec2 sigma, out vec2 u)
{
    // Fetch the direction tensors
    vec3 two = textured(kTensor2Tex) ? fetch(textures[kTensor2Tex], kTensor2Tex).xyz : vec3(1.0, 0.0, 0.0);
    vec3 four = textured(kTensor4Tex) && !has(kOneEta) ? fetch(textures[kTensor4Tex], kTensor4Tex).xyz : vec3(1.0, 0.0, 0.0);
    // Build the covariance
    float alpha = roughness * roughness, least = alpha, s = material.lobe.w;
    vec3 m;
    if (has(kOneEta)) {
        float trace = two.x + two.y, eta = trace > 1e-6 ? s : 0.0;
        least = alpha * (1.0 - eta);
        m = two / max(trace, 1e-6) * (4.0 * eta * alpha * alpha);
    } else
        m = two * (2.0 * alpha * (1.0 - alpha) * s * s) + four * ((1.0 - alpha) * (1.0 - alpha) * s * s * s * s);
    // Rotate by the material's angle
    vec2 turn = material.grain.xy;
    float mean = 0.5 * (least * least + 0.5 * (m.x + m.y));
    vec2 e = 0.5 * vec2(0.5 * (m.x - m.y), m.z);
    e = vec2((turn.x * turn.x - turn.y * turn.y) * e.x - 2.0 * turn.x * turn.y * e.y,
             2.0 * turn.x * turn.y * e.x + (turn.x * turn.x - turn.y * turn.y) * e.y);
    // Solve for eigenvalues and the wide axis
    float d = length(e);
    float floor2 = min(mean, 5e-7);
    sigma = sqrt(max(vec2(mean + d, mean - d), floor2));
    u = e.x >= 0.0 ? vec2(d + e.x, e.y) : vec2(abs(e.y), e.y < 0.0 ? e.x - d : d - e.x);
    u = d > 1e-12 ? normalize(u) : vec2(1.0, 0.0);
}

// Returns coordinates in tables that span both: the roots of n.v and of the cosine between the wide axis and the view's
// azimuth.
vec2 albedo_place(vec3 o) { return sqrt(vec2(clamp(o.z, 0.0, 1.0), min(abs(o.x) * inversesqrt(max(o.x * o.x + o.y * o.y, 1e-12)), 1.0))); }
// Returns coordinates in a lobe's own table of 24 x 12 texels, see lobe_slice_lookup (energy.k.h).
vec2 slice_place(vec3 o)
{
    float up = clamp(o.z, 0.0, 1.0), wide = 3.0 * abs(o.x);
    return vec2(1.2 * up / (up + 0.2), wide / max(wide + abs(o.y), 1e-6));
}
vec2 slice_of(sampler2D table, vec2 at) { return textureLod(table, at * vec2(frame.tables.z, 0.9) + vec2(frame.tables.w, 0.05), 0.0).xy; }

// Returns directional albedo of an anisotropic lobe, as scales for f0 and f90.
vec2 lobe_albedo(vec3 o, vec2 sigma, float roughness)
{
    if (has(kOneShape))
        return textureLod(slice_albedo, slice_place(o) * vec2(23.0 / 24.0, 11.0 / 12.0) + vec2(0.5 / 24.0, 0.5 / 12.0), 0.0).xy;
    vec2 at = albedo_place(o);
    float eta = (sigma.x - sigma.y) / max(sigma.x + sigma.y, 1e-20);
    float w = (1.0 - sqrt(max(1.0 - eta, 0.0))) * 9.0;
    float slab = min(floor(w), 8.0);
    vec3 place = vec3(vec2(at.x, roughness) * frame.tables.z + frame.tables.w, at.y * 0.09 + 0.005 + slab * 0.1);
    vec2 below = textureLod(width_albedo, place, 0.0).xy;
    vec2 above = textureLod(width_albedo, place + vec3(0.0, 0.0, 0.1), 0.0).xy;
    return mix(below, above, w - slab);
}

// Returns directional albedo of the surface's lobe.
vec2 directional_albedo(Surface s)
{
    if (has(kAnisotropic))
        return lobe_albedo(s.o, s.sigma, s.roughness);
    return textureLod(round_albedo, vec2(s.n_dot_v, s.roughness) * frame.tables.x + frame.tables.y, 0.0).xy;
}

// Finds the lobe's widths and axes from the shading frame's tangent and bitangent.
void place_lobe(inout Surface s, vec3 t, vec3 b)
{
    vec2 u = material.grain.xy;
    s.sigma = material.lobe.xy;
    s.stretch = material.grain.z;
    s.bent_level = material.grain.w;
    if (has(kAnisotropic) && !has(kOneShape)) {
        shape_by_texture(s.roughness, s.sigma, u);
        float mean = (s.sigma.x + s.sigma.y) * 0.70710678;
        s.roughness = min(sqrt(mean), 1.0);
    } else if (!has(kOneShape))
        s.sigma = vec2(s.roughness * s.roughness * 0.70710678);
    if (!has(kOneShape)) {
        float eta = (s.sigma.x - s.sigma.y) / max(s.sigma.x + s.sigma.y, 1e-20);
        s.stretch = min(eta * min(1.5 * sqrt(s.roughness), 1.0), 0.999);
        s.bent_level = s.roughness * min(1.2 - eta, 1.0);
    }
    s.u_axis = has(kAnisotropic) ? t * u.x + b * u.y : t;
    s.v_axis = has(kAnisotropic) ? b * u.x - t * u.y : b;
    s.o = vec3(dot(s.u_axis, s.v), dot(s.v_axis, s.v), max(dot(s.n, s.v), 1e-4));
}

// Returns the geometry's axes on the eye's side.
Axes geometric_axes()
{
    bool behind = has(kTwoSided) && !gl_FrontFacing;
    Axes a;
    a.n = normalize(behind ? -normal : normal);
    a.t = normalize(tangent.xyz - a.n * dot(a.n, tangent.xyz));
    a.hand = tangent.w < 0.0 != behind ? -1.0 : 1.0;
    a.b = cross(a.n, a.t) * a.hand;
    return a;
}

// Turns axes by a normal map's texel.
Axes mapped_axes(Axes a, vec3 texel, float scale)
{
    vec3 map = texel * 2.0 - 1.0;
    Axes m;
    m.n = normalize((a.t * map.x + a.b * map.y) * scale + a.n * map.z);
    m.t = normalize(a.t - m.n * dot(m.n, a.t));
    m.b = cross(m.n, m.t) * a.hand;
    m.hand = a.hand;
    return m;
}

// Makes the surface. base: base colour and alpha, with textures.
Surface surface_of(vec4 base, Axes geometry)
{
    Surface s;
    // Apply the normal map
    s.v = normalize(frame.eye.xyz - position * frame.eye.w);
    Axes axes = geometry;
    if (textured(kNormalTex))
        axes = mapped_axes(geometry, fetch(textures[kNormalTex], kNormalTex).xyz, material.factors.z);
    s.n = axes.n;
    // Evaluate roughness and metalness
    s.roughness = material.lobe.z;
    float metallic = material.factors.x;
    if (textured(kMetalRoughTex)) {
        vec2 of_texture = fetch(textures[kMetalRoughTex], kMetalRoughTex).yz;
        metallic *= of_texture.y;
        if (!has(kOneShape) && !has(kFactorRoughness))
            s.roughness = clamp(s.roughness * of_texture.x, 0.0, 1.0);
    }
    // Place the lobe
    s.n_dot_v = clamp(dot(s.n, s.v), 1e-4, 1.0);
    place_lobe(s, axes.t, axes.b);
    // Mix the reflectances
    s.dielectric_f0 = material.dielectric.rgb;
    s.dielectric_f90 = material.dielectric.w;
    if (textured(kBaseColorTex) || textured(kMetalRoughTex) || has(kVertexColors)) {
        s.f0 = mix(s.dielectric_f0, base.rgb, metallic);
        s.f90 = mix(s.dielectric_f90, 1.0, metallic);
        s.diffuse = base.rgb * (1.0 - metallic);
    } else {
        s.f0 = material.f0.rgb;
        s.f90 = material.f0.w;
        s.diffuse = material.diffuse.rgb;
    }
    // Look up albedo; evaluate occlusion and emission
    s.dfg = directional_albedo(s);
    s.albedo = s.f0 * s.dfg.x + s.f90 * s.dfg.y;
    s.occlusion = textured(kOcclusionTex) ? 1.0 + material.factors.w * (fetch(textures[kOcclusionTex], kOcclusionTex).x - 1.0) : 1.0;
    s.emissive = material.emissive.rgb;
    if (textured(kEmissiveTex))
        s.emissive *= fetch(textures[kEmissiveTex], kEmissiveTex).rgb;
    return s;
}

#endif
