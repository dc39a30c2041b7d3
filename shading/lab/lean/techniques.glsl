// Techniques for environment light, the same as in shading/techniques, each written from its paper or its page. A function
// returns the radiance that the lobe reflects, before the environment's scale.
#ifndef BN_LEAN_TECHNIQUES_GLSL
#define BN_LEAN_TECHNIQUES_GLSL

#include "shading/lab/lean/surface.glsl"

layout(std430, set = 0, binding = 2) readonly buffer LeanGrid { float grid[]; }; // slopes and density, three per sample

const float kRoot2 = 1.41421356;

vec3 specular_at(vec3 direction, float level) { return textureLod(cubes[0], direction, level).rgb; }
float level_of(float radius) { return min(sqrt(radius), 1.0) * frame.scale.w; }
vec3 to_world(Surface s, vec3 w) { return s.u_axis * w.x + s.v_axis * w.y + s.n * w.z; }
vec3 mirror(vec3 w, vec3 h) { return h * (2.0 * dot(w, h)) - w; } // mirrors w about h
vec3 fresnel(Surface s, float cosine)
{
    float m = 1.0 - clamp(cosine, 0.0, 1.0), m2 = m * m;
    return s.f0 + (s.f90 - s.f0) * (m2 * m2 * m);
}

vec3 split_isotropic(Surface s) { return specular_at(reflect(-s.v, s.n), s.roughness * frame.scale.w) * s.albedo; }

vec3 bent_normal(Surface s)
{
    vec3 across = s.v - s.v_axis * dot(s.v, s.v_axis);
    vec3 bent = normalize(mix(s.n, across, s.stretch));
    return specular_at(reflect(-s.v, bent), s.bent_level * frame.scale.w) * s.albedo;
}

// Finds the points of the unit circle that the ellipse of slopes stretches nearest to and farthest from the mirror
// direction. Cocco et al. 2024, appendix A.
void extreme_points(vec3 o, vec2 r, out vec2 nearest, out vec2 farthest)
{
    vec2 b = 1.0 + r * r;
    float g0 = 2.0 * o.x * o.y * r.x * r.y;
    float g1 = (r.x - r.y) * (r.x + r.y) + o.x * o.x * r.y * r.y * b.x - o.y * o.y * r.x * r.x * b.y;
    float root = sqrt(g1 * g1 + g0 * g0 * b.x * b.y), w = abs(g1) + root;
    nearest = g1 >= 0.0 ? vec2(-g0 * b.y, w) : vec2(w, -g0 * b.x);
    farthest = g1 >= 0.0 ? vec2(w, g0 * b.x) : vec2(g0 * b.y, w);
    if (w <= 1e-30) {
        nearest = vec2(1.0, 0.0);
        farthest = vec2(0.0, 1.0);
    }
}

float half_turn(vec2 p) // angle, (-pi/2, pi/2]
{
    float t = atan(p.y, p.x);
    return t > 1.57079633 ? t - 3.14159265 : t <= -1.57079633 ? t + 3.14159265 : t;
}

// Prefiltered samples along the lobe's major axis. Cocco et al. 2024.
vec3 major_axis(Surface s)
{
    // Find the ellipse's extreme points
    vec3 o = s.o;
    vec2 r = s.sigma * frame.axis.x, nearest, farthest;
    extreme_points(o, r, nearest, farthest);
    float t_near = half_turn(nearest), t_far = half_turn(farthest);
    // Find the ends of the major axis
    vec2 p = r * vec2(cos(t_far), sin(t_far));
    float p2 = dot(p, p), q = dot(p, o.xy), root = abs(q) + sqrt(q * q + o.z * o.z * p2);
    float small = o.z / max(root, 1e-20), large = root / max(o.z * p2, 1e-20);
    float a = min(q >= 0.0 ? small : large, 1.0), b = min(q >= 0.0 ? large : small, 1.0);
    vec3 end0 = normalize(vec3(-a * p, 1.0)), end1 = normalize(vec3(b * p, 1.0));
    // Measure the lobe's width and extent
    float delta = 0.5 * (b - a) * (t_near - t_far);
    vec3 m0 = normalize(vec3(-r * vec2(cos(t_near + delta), sin(t_near + delta)), 1.0));
    vec3 m1 = normalize(vec3(r * vec2(cos(t_near - delta), sin(t_near - delta)), 1.0));
    float width = distance(mirror(o, m0), mirror(o, m1)), extent = distance(mirror(o, end0), mirror(o, end1));
    // Shorten the axis by the width, and choose the mip level
    float zeta = clamp(1.0 - width / max(extent, 1e-20), 0.0, 1.0);
    vec3 centre = normalize(end0 + end1);
    vec3 e0 = normalize(mix(centre, end0, zeta)), e1 = normalize(mix(centre, end1, zeta));
    float radius = max(width / (2.0 * max(frame.axis.x, 1e-6)), frame.axis.y * extent / float(2 * kSamples));
    float level = level_of(radius);
    e0 = to_world(s, e0);
    vec3 along = to_world(s, e1) - e0;
    // Expand the mirror direction times |e|^2 as a parabola along the line
    vec3 start = mirror(s.v, e0), linear, quadratic;
    float start_o = 2.0 * dot(e0, s.v), step_o = 2.0 * dot(along, s.v);
    start = e0 * start_o - s.v * dot(e0, e0);
    linear = along * start_o + e0 * step_o - s.v * (2.0 * dot(e0, along));
    quadratic = along * step_o - s.v * dot(along, along);
    // Average the samples
    vec3 sum = vec3(0.0);
    for (int j = 0; j < kSamples; ++j) {
        float at = kSamples == 1 ? 0.5 : float(j) / float(max(kSamples - 1, 1));
        sum += specular_at(start + (linear + quadratic * at) * at, level);
    }
    return sum * (1.0 / float(kSamples)) * s.albedo;
}

struct Grain {
    vec3 o;
    vec2 along, alpha;
    float own, width, o_along, o_across2;
};

Grain grain_of(Surface s)
{
    Grain g;
    g.o = s.o;
    g.alpha = s.sigma * kRoot2;
    vec2 nearest, farthest;
    extreme_points(g.o, s.sigma, nearest, farthest);
    vec2 p = g.alpha * normalize(farthest / max(max(abs(farthest.x), abs(farthest.y)), 1e-30));
    float inv = inversesqrt(max(dot(p, p), 1e-30));
    g.width = g.alpha.x * g.alpha.y * inv;
    float across = (g.o.y * p.x - g.o.x * p.y) * inv;
    g.o_across2 = across * across;
    g.o_along = sqrt(max(1.0 - g.o_across2, 0.0));
    g.own = g.o_along / inv;
    float ratio = g.width * sqrt(g.o_across2 + g.o.z * g.o.z) / max(g.own, 1e-20);
    g.along = p * (frame.axis.x * sqrt(max(1.0 - ratio * ratio, 0.0)));
    return g;
}

// Returns weighted radiance, and the weight in w.
vec4 grain_sample(Surface s, Grain g, float c, float root, float spacing, float narrow, float weight)
{
    // Find the half vector and its mirror direction
    vec3 w = vec3(g.along * c, root);
    float w2 = dot(w, w), w_dot_o = dot(w, g.o), inv2 = 1.0 / w2;
    vec3 i = w * (2.0 * w_dot_o) - g.o * w2;
    // Weight the sample by masking
    float up = max(i.z, 0.0);
    float smith = up / max(up + length(vec3(g.alpha * i.xy, i.z)), 1e-20);
    float visible = max(w_dot_o, 0.0) / root * smith * weight;
    // Choose the filter radius
    float across = g.width * sqrt((g.o_across2 + w_dot_o * w_dot_o * inv2) * inv2);
    float along = length(g.along) * g.o_along * inv2 / root * spacing * 0.33;
    float radius = max(across, min(along, g.own)) * narrow;
    return vec4(specular_at(to_world(s, i), level_of(radius)), 1.0) * visible;
}

vec3 major_axis_weighted(Surface s)
{
    Grain g = grain_of(s);
    const float step_c = 2.0 / float(kSamples);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < kSamples; ++j) {
        float c = (float(j) + 0.5) * step_c - 1.0;
        sum += grain_sample(s, g, c, sqrt(1.0 - c * c), frame.axis.y * 0.48 * step_c, 0.65, 1.0);
    }
    return sum.rgb / max(sum.w, 1e-20) * s.albedo;
}

vec3 major_axis_adaptive(Surface s)
{
    Grain g = grain_of(s);
    const float limit = float(kSamples - (kSamples % 2 == 0 ? 1 : 0));
    float across = g.width * sqrt(g.o_across2 + g.o.z * g.o.z);
    float count = clamp(frame.axis.y * 0.43 * length(g.along) * g.o_along / max(across, 1e-6), 1.0, limit);
    float size = 2.0 / count, spacing = frame.axis.y * size;
    vec4 sum = grain_sample(s, g, 0.0, 1.0, spacing, 1.0, 1.0);
    for (int i = 1; float(2 * i - 1) < count; ++i) {
        float begin = (float(i) - 0.5) * size, left = clamp(1.0 - begin, 0.0, size);
        float c = min(begin + left * 0.5, 1.0) * 0.95, root = sqrt(1.0 - c * c);
        sum += grain_sample(s, g, c, root, spacing, 1.0, left / size);
        sum += grain_sample(s, g, -c, root, spacing, 1.0, left / size);
    }
    return sum.rgb / max(sum.w, 1e-20) * s.albedo;
}

// A line of lobes, see shading/techniques/lobe_line.k.h.
struct Line {
    vec3 o, axis;
    vec2 along, alpha;
    float level, widen, upright, lift, even, stretch;
};

struct LineSum {
    vec3 light, weights; // by channel
};

void line_sample(Surface s, Line line, float t, float weight, inout LineSum sum)
{
    float t2 = t * t, bend = line.even * t2, scale = 1.0 + bend;
    float root = sqrt(max((1.0 - t2) * (1.0 - line.even * bend), 1e-3)) + line.upright, c = t + line.even * t;
    vec3 w = vec3(-line.along * c, root);
    float w_dot_o = dot(w, line.o), seen = max(w_dot_o, 0.0), w2 = dot(w, w), share = seen / w2, size = share * scale;
    vec3 i = w * (2.0 * w_dot_o) - line.axis * w2 + vec3(0.0, 0.0, line.lift * size * seen);
    float up = max(i.z, 0.0), smith = up * line.stretch + line.o.z * length(vec3(line.alpha * i.xy, i.z));
    float visible = weight * seen * up * (1.0 - bend) / (root * scale * scale * max(smith, 1e-20));
    float radius = (line.level + line.widen * size) * size, away = 1.0 - min(sqrt(share * seen), 1.0), away2 = away * away;
    vec3 reflectance = max(s.f0 + (s.f90 - s.f0) * (away2 * away2 * away), vec3(1e-4)) * visible;
    sum.light += specular_at(to_world(s, i), level_of(radius)) * reflectance;
    sum.weights += reflectance;
}

vec3 lobe_line(Surface s)
{
    // Find the visible ellipse of the lobe, and its major axis
    Line line;
    line.o = s.o;
    line.alpha = s.sigma * kRoot2;
    vec2 p = line.alpha * line.o.xy, z = line.alpha * line.o.z;
    float m = 0.5 * (dot(p, p) + dot(z, z)), h = 0.5 * ((z.x - z.y) * (z.x + z.y) + (p.x - p.y) * (p.x + p.y)), shear = p.x * p.y;
    float d = sqrt(h * h + shear * shear), l1 = max(m + d, 1e-20), least = line.alpha.x * z.y;
    float ratio = min(least * least / (l1 * l1), 1.0);
    vec2 e = h >= 0.0 ? vec2(d + h, shear) : vec2(abs(shear), shear < 0.0 ? h - d : d - h);
    line.along = line.alpha * e * (sqrt(1.0 - ratio) * inversesqrt(max(dot(e, e), 1e-30)));
    // Set up level, width and corrections
    float width = sqrt(l1 * ratio) / line.o.z, square = width * width, grazing = (0.78 + 0.22 * line.o.z) * width;
    line.level = (0.66 - 0.13 * ratio) * grazing;
    line.widen = 1.29 * width * grazing;
    line.axis = line.o * (1.0 + 0.64 * square * line.o.z * line.o.z) - vec3(0.0, 0.0, 1.19 * square * line.o.z);
    line.upright = 0.13 * square * line.o.z * line.o.z;
    line.lift = 1.92 * square;
    float extent = sqrt((1.0 - ratio) / max(ratio, 1e-12));
    line.even = extent / (extent + 6.0);
    line.stretch = length(vec3(p, line.o.z));
    // Take the middle sample, then pairs on both sides
    float count = min(1.0 + 4.0 * extent, float(kSamples - (kSamples % 2 == 0 ? 1 : 0)));
    line.level *= 1.0 + 0.7 / count;
    float size = 2.0 / count;
    LineSum sum = LineSum(vec3(0.0), vec3(0.0));
    line_sample(s, line, 0.0, 1.0, sum);
    for (int i = 1; float(2 * i - 1) < count; ++i) {
        float begin = (float(i) - 0.5) * size, left = clamp(1.0 - begin, 0.0, size), t = begin + 0.5 * left;
        line_sample(s, line, t, left / size, sum);
        line_sample(s, line, -t, left / size, sum);
    }
    return sum.light / max(sum.weights, vec3(1e-20)) * s.albedo;
}

float beckmann_lambda_z(vec2 alpha, vec3 w) // w.z times Smith's Lambda, rational fit
{
    float s = length(alpha * w.xy), c = min(w.z / max(s, 1e-12), 1.6);
    return c < 1.6 ? s * (1.0 - 1.259 * c + 0.396 * c * c) / (3.535 + 2.181 * c) : 0.0;
}

vec3 filtered_is(Surface s, bool ggx)
{
    if (has(kMirror))
        return specular_at(reflect(-s.v, s.n), 0.0) * s.albedo;
    vec3 o = s.o;
    vec2 alpha = max(s.sigma * kRoot2, 1e-3);
    float of_eye = ggx ? length(vec3(alpha * o.xy, o.z)) : beckmann_lambda_z(alpha, o);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kSamples; ++i) {
        vec3 h = normalize(vec3(-alpha * vec2(grid[3 * i], grid[3 * i + 1]), 1.0));
        float oh = dot(o, h);
        vec3 wi = mirror(o, h);
        float pdf = grid[3 * i + 2] / (4.0 * alpha.x * alpha.y * h.z * h.z * h.z * max(oh, 1e-8));
        float lod = max(frame.axis.z - 0.5 * log2(max(pdf, 1e-30)), 0.0);
        float masking = ggx ? 0.5 / max(wi.z * of_eye + o.z * length(vec3(alpha * wi.xy, wi.z)), 1e-16)
                            : 0.25 / max(o.z * wi.z + wi.z * of_eye + o.z * beckmann_lambda_z(alpha, wi), 1e-16);
        float weight = oh > 0.0 && wi.z > 0.0 ? 4.0 * wi.z * oh / h.z * masking : 0.0;
        sum += textureLod(cubes[2], to_world(s, wi), lod).rgb * fresnel(s, oh) * weight;
    }
    return sum * (frame.scale.z / (frame.scale.x * float(kSamples)));
}

// Samples the half vectors of an Ashikhmin-Shirley lobe on a lattice: see as_mc.t.h.
vec3 as_mc(Surface s)
{
    if (has(kMirror) || kSamples == 1)
        return specular_at(reflect(-s.v, s.n), 0.0) * s.albedo;
    vec3 o = s.o;
    vec2 alpha = max(s.sigma * kRoot2, 1e-3), n = 1.0 / (alpha * alpha), wide = sqrt(n.yx + 1.0);
    float term = frame.axis.z + 0.5 * log2(12.5663706 / (wide.x * wide.y));
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        vec2 d = normalize(wide * vec2(grid[18 * i], grid[18 * i + 4])); // the first of four sets in a block
        float e = dot(n, d * d), lg = grid[18 * i + 8] / (e + 1.0);
        float less = lg > -0.01 ? lg * (1.0 + lg * (0.5 + lg * 0.16666667)) : exp(lg) - 1.0; // cosine - 1
        vec3 h = vec3(d * sqrt(max(-less * (less + 2.0), 0.0)), less + 1.0);
        float oh = dot(o, h);
        vec3 wi = mirror(o, h);
        float weight = oh > 0.0 && wi.z > 0.0 ? wi.z / max(max(o.z, wi.z), 1e-4) : 0.0;
        float lod = floor(max(term + 0.5 * log2(max(oh, 1e-4)) - e * lg * 0.72134752, 0.0) + 0.5);
        sum += textureLod(cubes[2], to_world(s, wi), lod).rgb * fresnel(s, oh) * weight;
        weights += weight;
    }
    float mean = 1.0 / float(kSamples);
    if (has(kPhongTable)) { // scale a few samples to the exact albedo
        vec2 own = slice_of(phong_albedo, albedo_place(o));
        mean *= (own.x + own.y) / max(weights / float(kSamples), 1e-4);
    }
    return sum * (mean * frame.scale.z / frame.scale.x);
}

uint hash(uint i)
{
    i = (i ^ i >> 16) * 0x7feb352du;
    i = (i ^ i >> 15) * 0x846ca68bu;
    return i ^ i >> 16;
}
float unit(uint bits) { return float(bits >> 8) * 5.9604645e-8; }

// Samples visible GGX normals with a Hammersley set, shifted per pixel. Dupuy and Benyoub 2023.
vec3 mc(Surface s)
{
    if (has(kMirror))
        return specular_at(reflect(-s.v, s.n), 0.0) * s.albedo;
    vec3 o = s.o;
    vec2 alpha = max(s.sigma * kRoot2, 1e-3);
    float of_eye = length(vec3(alpha * o.xy, o.z));
    vec3 stretched = normalize(vec3(alpha * o.xy, o.z));
    uint seed = hash(uint((int(gl_FragCoord.y) + pass.first_row) * int(frame.axis.w) + int(gl_FragCoord.x)));
    vec2 shift = vec2(unit(seed), unit(hash(seed)));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kSamples; ++i) {
        vec2 xi = fract(vec2((float(i) + 0.5) / float(kSamples), unit(bitfieldReverse(uint(i)))) + shift);
        float height = (1.0 - xi.y) * (1.0 + stretched.z) - stretched.z, r = sqrt(max(1.0 - height * height, 0.0));
        float turn = 6.28318531 * xi.x;
        vec3 seen = vec3(r * cos(turn), r * sin(turn), height) + stretched;
        vec3 h = normalize(vec3(alpha * seen.xy, seen.z)), wi = mirror(o, h);
        float bottom = wi.z * of_eye + o.z * length(vec3(alpha * wi.xy, wi.z));
        float weight = wi.z > 0.0 ? wi.z * (o.z + of_eye) / max(bottom, 1e-16) : 0.0;
        sum += specular_at(to_world(s, wi), 0.0) * fresnel(s, dot(o, h)) * weight;
    }
    return sum * (1.0 / float(kSamples));
}

#endif
