// Lamps and area lights on a surface, as an engine has them: GGX for lamps; for area lights linearly transformed cosines from a texture,
// by the device's own filters. Heitz, Dupuy, Hill, Neubelt 2016; KT, Heitz, Dupuy, Narayanan 2022; Heitz, Hill 2017 for discs and lines.
#ifndef BN_LEAN_LIGHTS_GLSL
#define BN_LEAN_LIGHTS_GLSL

#include "shading/lab/lean/coat.glsl"

// counts: lamps, area lights. Then the lamps, four vec4 each; then the area lights, nineteen each: see lean_lights.cpp.
layout(std430, set = 0, binding = 7) readonly buffer LeanLights
{
    vec4 counts;
    vec4 data[];
}
lights;
layout(set = 0, binding = 8) uniform sampler3D cosines; // lambda, root of alpha, 3 x 8 x 8 of channels, theta, phi

const int kLampStride = 4, kAreaStride = 19, kAreaPoints = 3;
const int kDisk = 2, kSphere = 3, kLine = 4; // shapes (core/scene/area_light.def); all others are polygons
const float kPi = 3.14159265;

vec2 alphas_under_lights(Surface s)
{
    return has(kRoundLights) ? vec2(s.roughness * s.roughness) : s.sigma * kRoot2;
}

// Returns the share of the diffuse part's light that the specular part lets through.
float diffuse_share(Surface s)
{
    vec3 kept = s.dielectric_f0 * s.dfg.x + s.dielectric_f90 * s.dfg.y;
    return 1.0 - max(kept.r, max(kept.g, kept.b));
}

// Returns the lamps' light on the surface, and adds their light on the coat to gloss.
vec3 light_of_lamps(Surface s, Coat coat, inout vec3 gloss)
{
    vec3 sum = vec3(0.0);
    vec2 alpha = max(alphas_under_lights(s), 1e-3);
    vec3 dull = has(kDiffuse) ? s.diffuse * (diffuse_share(s) / kPi) : vec3(0.0);
    float of_eye = length(vec3(alpha * s.o.xy, s.o.z));
    float coat_alpha = max(coat.roughness * coat.roughness, 1e-3), coat_alpha2 = coat_alpha * coat_alpha;
    float coat_of_eye = coat_stretch(coat.n_dot_v, coat_alpha2);
    for (int i = 0; i < int(lights.counts.x); ++i) {
        // Find direction and irradiance
        vec4 place = lights.data[kLampStride * i], axis = lights.data[kLampStride * i + 1], radiant = lights.data[kLampStride * i + 2];
        bool distant = lights.data[kLampStride * i + 3].x != 0.0;
        vec3 towards = distant ? -axis.xyz : place.xyz - position;
        float d2 = max(dot(towards, towards), 1e-12);
        vec3 l = towards * inversesqrt(d2);
        float window = clamp(1.0 - d2 * place.w * d2 * place.w, 0.0, 1.0);
        float cone = clamp(dot(-l, axis.xyz) * axis.w + radiant.w, 0.0, 1.0);
        float reach = distant ? 1.0 : window * cone * cone / d2;
        // Evaluate the coat
        if (has(kCoat)) {
            float on_coat = dot(coat.axes.n, l);
            if (on_coat > 0.0 && reach > 0.0)
                gloss += radiant.rgb * (coat_brdf(coat, s.v, l, on_coat, coat_alpha2, coat_of_eye) * reach * on_coat);
        }
        // Evaluate the lobe and the diffuse part
        float cosine = dot(s.n, l);
        if (cosine <= 0.0 || reach <= 0.0)
            continue;
        vec3 i_lobe = vec3(dot(s.u_axis, l), dot(s.v_axis, l), cosine), h = normalize(i_lobe + s.o);
        vec2 slope = h.xy / alpha;
        float spread = dot(slope, slope) + h.z * h.z;
        float d = 1.0 / (kPi * alpha.x * alpha.y * spread * spread);
        float masking = 0.5 / max(cosine * of_eye + s.o.z * length(vec3(alpha * i_lobe.xy, cosine)), 1e-16);
        sum += (dull + fresnel(s, dot(s.o, h)) * (d * masking)) * radiant.rgb * (reach * cosine);
    }
    return sum;
}

// A lobe as a transformed cosine, in the lobe's axes.
struct Cosine {
    mat3 to_cosine, to_lobe; // from the lobe's axes, and back to these
    vec2 albedo; // for Fresnel 1, and for (1 - v.h)^5
};

// Returns four channels of the table. at: lambda, root of alpha, phi's place in a slab of theta; two slabs are mixed by hand.
vec4 channels(int plane, vec3 at, float slab, float above)
{
    float z = float(64 * plane) + 8.0 * slab + at.z;
    vec4 lower = textureLod(cosines, vec3(at.xy, z / 192.0), 0.0), upper = textureLod(cosines, vec3(at.xy, (z + 8.0) / 192.0), 0.0);
    return mix(lower, upper, above);
}

// o: to the eye, in the lobe's axes.
Cosine cosine_of(vec3 o, vec2 alpha)
{
    // Find the place in the table's quadrant
    vec2 side = vec2(o.x < 0.0 ? -1.0 : 1.0, o.y < 0.0 ? -1.0 : 1.0);
    vec3 e = normalize(vec3(abs(o.xy), max(o.z, 0.02)));
    float wide = clamp(alpha.x, 0.002, 2.0), ratio = max(alpha.y, 1e-6) / max(alpha.x, 1e-6);
    float theta = acos(min(e.z, 1.0)) * (7.0 / 1.57079633), phi = e.x + e.y > 0.0 ? atan(e.y, e.x) * (7.0 / 1.57079633) : 0.0;
    float slab = min(floor(theta), 6.0);
    vec3 at = vec3((clamp(ratio, 0.02, 1.0) * 7.0 + 0.5) / 8.0, (sqrt(wide) * 7.0 + 0.5) / 11.0, phi + 0.5);
    vec4 a = channels(0, at, slab, theta - slab), b = channels(1, at, slab, theta - slab), c = channels(2, at, slab, theta - slab);
    // Turn the matrix from the mirror direction to the lobe's axes, and back to the eye's quadrant
    vec3 m[3] = vec3[](vec3(a.x, a.w, b.z) * wide, vec3(a.y, b.x, b.w) * wide, vec3(a.z, b.y, c.x));
    for (int k = 0; k < 3; ++k) {
        float towards = -dot(e.xy, m[k].xy), back = m[k].z - towards / (1.0 + e.z);
        m[k] = vec3((m[k].xy - e.xy * back) * side, e.z * m[k].z - towards);
    }
    mat3 to_lobe = mat3(m[0], m[1], m[2]);
    return Cosine(inverse(to_lobe), to_lobe, clamp(c.yz, 0.0, 1.0));
}

// Returns an arc's angle times the z of its unit axis, over 2 pi. a, b: unit. Fit of the angle over its sine: Hill, Heitz 2016, "Real-Time
// Area Lighting: a Journey from Research to Production". The sine is the length of the cross product, which keeps its digits where a and b are
// opposite.
float arc(vec3 a, vec3 b)
{
    vec3 across = cross(a, b);
    float x = dot(a, b), y = abs(x), sine = max(length(across), 1e-7);
    float fit = (0.8543985 + (0.4965155 + 0.0145206 * y) * y) / (3.4175940 + (4.1616724 + y) * y);
    return across.z * (x > 0.0 ? fit : 0.5 / sine - fit);
}
vec3 safe_normalize(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-30)); }

// Returns a polygon's share of a cosine, clipped at the horizon. at: its first corner in the buffer. From within its plane it has none.
float polygon_share(mat3 to_cosine, int at, int corners)
{
    vec3 c0 = lights.data[at].xyz - position, side = lights.data[at + 1].xyz - lights.data[at].xyz;
    vec3 normal = cross(side, lights.data[at + 2].xyz - lights.data[at].xyz);
    if (abs(dot(c0, normal)) <= 1e-6 * length(normal) * (length(c0) + length(side)))
        return 0.0;
    vec3 a = to_cosine * (lights.data[at + corners - 1].xyz - position), rise = vec3(1.0, 0.0, 0.0), fall = rise;
    float sum = 0.0;
    for (int k = 0; k < corners; ++k) {
        vec3 b = to_cosine * (lights.data[at + k].xyz - position);
        if (a.z > 0.0 || b.z > 0.0) {
            vec3 from = safe_normalize(a), to = safe_normalize(b);
            if (a.z <= 0.0)
                from = rise = safe_normalize(mix(a, b, a.z / (a.z - b.z)));
            if (b.z <= 0.0)
                to = fall = safe_normalize(mix(a, b, a.z / (a.z - b.z)));
            sum += arc(from, to);
        }
        a = b;
    }
    return min(abs(sum + arc(fall, rise)), 1.0);
}

// Returns the share of a sphere above the horizon. flow: its vector form factor. Snyder 1996.
float sphere_share(vec3 flow)
{
    float size = min(length(flow), 1.0), z = clamp(flow.z / max(size, 1e-15), -1.0, 1.0), sine = sqrt(size), cosine = sqrt(1.0 - size);
    if (z >= sine)
        return z * size;
    if (z <= -sine)
        return 0.0;
    float across = sqrt(max(1.0 - z * z, 1e-12)), cut = min(cosine / across, 1.0), k = sqrt(1.0 - cut * cut);
    float in_plane = acos(cut) + cut * k - 2.0 * across * cosine * k;
    float off_plane = abs(z) * (k * sqrt(max(size - k * k, 0.0)) + size * asin(min(k / max(sine, 1e-15), 1.0)));
    return clamp(max(z, 0.0) * size + (in_plane - off_plane) / kPi, 0.0, 1.0);
}

// Returns a disc's share. All in the cosine's space: the middle, and two half axes.
float disk_share(vec3 middle, vec3 p, vec3 q)
{
    // Find the ellipse's own axes
    float scale = inversesqrt(max(max(dot(middle, middle), 1e-12 * max(dot(p, p), dot(q, q))), 1e-30));
    middle *= scale, p *= scale, q *= scale;
    vec2 slant = vec2(dot(p, p) - dot(q, q), 2.0 * dot(p, q));
    float turn = dot(slant, slant) > 0.0 ? 0.5 * atan(slant.y, slant.x) : 0.0, c = cos(turn), s = sin(turn);
    vec3 a = p * c + q * s, b = q * c - p * s;
    vec2 half2 = max(vec2(dot(a, a), dot(b, b)), 1e-20);
    a *= inversesqrt(half2.x), b *= inversesqrt(half2.y);
    vec3 n = cross(a, b), at = vec3(dot(middle, a), dot(middle, b), dot(middle, n)), at2 = at * at;
    // Solve sum(at^2 / (half^2 + m)) = 1 by Newton's method: the cone's axis is at / (half^2 + m)
    vec2 left = 1.0 - vec2(at2.x, at2.x + at2.y * half2.x / half2.y) / half2.x;
    float m = min(min(left.x > 1e-6 ? (at2.y + at2.z) / left.x : 1.0, left.y > 1e-6 ? at2.z / left.y : 1.0), 1.0), least = max(at2.z, 1e-20);
    for (int i = 0; i < 6; ++i) {
        vec2 over = 1.0 / (half2 + m);
        float value = m - at2.z - m * dot(at2.xy, over), slope = 1.0 - dot(at2.xy * half2, over * over);
        m = clamp(m - value / max(slope, 1e-6), least, 1.0);
    }
    // Make the form factor
    vec3 axis = normalize(a * (at.x * m / (half2.x + m)) + b * (at.y * m / (half2.y + m)) + n * at.z);
    float others = max(half2.x + half2.y - dot(at2, vec3(1.0)) + 2.0 * m, m);
    float ratio = sqrt(half2.x * half2.y / others) * abs(at.z) / m;
    return sphere_share(axis * (ratio * inversesqrt(1.0 + ratio * ratio)));
}

// Returns the share of a tube from p to q, both relative to the point and in the lobe's axes.
float line_share(Cosine lobe, vec3 p, vec3 q, float radius)
{
    // Clip at the horizon of the cosine's space
    vec3 a = lobe.to_cosine * p, b = lobe.to_cosine * q;
    if (a.z <= 0.0 && b.z <= 0.0)
        return 0.0;
    vec3 cut = mix(a, b, a.z / (a.z - b.z));
    a = a.z <= 0.0 ? cut : a;
    b = b.z <= 0.0 ? cut : b;
    // Integrate the cosine along the line
    float extent = max(distance(a, b), 1e-15);
    vec3 t = (b - a) / extent;
    float from = dot(a, t), to = from + extent;
    vec3 foot = a - t * from;
    float d = max(max(length(foot), extent * 1e-4), 1e-15), d2 = d * d, over = extent / ((d2 + from * from) * (d2 + to * to));
    float across = over * (d2 - from * to) + atan(d * extent, d2 + from * to) / d, along = over * d * (from + to);
    // Multiply by the tube's width in that space
    float narrow = length(safe_normalize(cross(p, q)) * lobe.to_lobe);
    return narrow > 1e-7 ? clamp(radius * (across * foot.z / d + along * t.z) / (kPi * narrow), 0.0, 1.0) : 0.0; // the line points here
}

// Returns an area light's share of a lobe. at: the light's place in the buffer. axes: from world space to the lobe's axes.
float area_share(int at, Cosine lobe, mat3 axes)
{
    vec4 shape = lights.data[at];
    int kind = int(shape.x), points = at + kAreaPoints;
    vec3 first = axes * (lights.data[points].xyz - position);
    if (kind == kDisk) {
        mat3 to_cosine = lobe.to_cosine * axes;
        return disk_share(lobe.to_cosine * first, to_cosine * lights.data[points + 1].xyz, to_cosine * lights.data[points + 2].xyz);
    }
    if (kind == kSphere) { // as the disc with its outline
        float outside = dot(first, first) - shape.z * shape.z;
        if (outside <= 0.0)
            return 1.0;
        vec3 w = normalize(first), u = normalize(abs(w.x) > 0.5 ? vec3(w.y, -w.x, 0.0) : vec3(0.0, w.z, -w.y));
        float size = shape.z * inversesqrt(outside);
        return disk_share(lobe.to_cosine * w, lobe.to_cosine * (u * size), lobe.to_cosine * (cross(w, u) * size));
    }
    if (kind == kLine)
        return line_share(lobe, first, axes * (lights.data[points + 1].xyz - position), shape.z);
    return polygon_share(lobe.to_cosine * axes, points, int(shape.y));
}

// Returns the area lights' light on the surface, and adds their light on the coat to gloss.
vec3 light_of_areas(Surface s, Coat coat, inout vec3 gloss)
{
    Cosine shiny = cosine_of(s.o, alphas_under_lights(s)), dull = Cosine(mat3(1.0), mat3(1.0), vec2(1.0, 0.0)), clear = dull;
    mat3 axes = transpose(mat3(s.u_axis, s.v_axis, s.n)), coat_axes = axes;
    if (has(kCoat)) {
        coat_axes = transpose(mat3(coat.axes.t, coat.axes.b, coat.axes.n));
        clear = cosine_of(vec3((coat_axes * s.v).xy, coat.n_dot_v), vec2(coat.roughness * coat.roughness));
    }
    vec3 specular = vec3(0.0), diffuse = vec3(0.0), on_coat = vec3(0.0);
    for (int i = 0; i < int(lights.counts.y); ++i) {
        // Skip lights that face away
        int at = kLampStride * int(lights.counts.x) + kAreaStride * i;
        bool one_sided = lights.data[at].w != 0.0;
        if (one_sided && dot(lights.data[at + kAreaPoints].xyz - position, lights.data[at + 2].xyz) >= 0.0)
            continue;
        vec3 radiance = lights.data[at + 1].rgb;
        specular += radiance * area_share(at, shiny, axes);
        if (has(kDiffuse))
            diffuse += radiance * area_share(at, dull, axes);
        if (has(kCoat))
            on_coat += radiance * area_share(at, clear, coat_axes);
    }
    if (has(kCoat))
        gloss += on_coat * (coat.share * clear.albedo.x);
    vec3 sum = specular * (s.f0 * (shiny.albedo.x - shiny.albedo.y) + s.f90 * shiny.albedo.y);
    return has(kDiffuse) ? sum + s.diffuse * diffuse * diffuse_share(s) : sum;
}

#endif
