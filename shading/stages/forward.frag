// Fragments of the forward pipeline: the device interpolates, and each fragment is shaded once. With BN_STAGES the output
// is four of a fragment's recorded words instead of its colour (kGpuForwardGroups).
#version 460
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shading/lang/interface.glsl"
#include "shading/kernels/camera.t.h"
#include "shading/lights/fragment_light.t.h"
#include "shading/surface/coverage.t.h"
#include "shading/surface/parallax.t.h"
#include "shading/surface/specular_aa.t.h"
#include "shading/stages/pass.glsl"

#ifdef BN_CENTROID // the device's own centroid in partly covered pixels: cheaper, but at another place
#define BN_FROM_VERTEX centroid in
#define BN_AT_POINT(v) v
#else
#define BN_FROM_VERTEX in
#define BN_AT_POINT(v) (kMsaa == 1 ? v : interpolateAtOffset(v, offset))
#endif
layout(location = 0) BN_FROM_VERTEX vec3 normal;
layout(location = 1) BN_FROM_VERTEX vec4 tangent;
layout(location = 2) BN_FROM_VERTEX vec4 uv;
layout(location = 3) BN_FROM_VERTEX vec4 color;
layout(location = 4) BN_FROM_VERTEX vec4 position;
layout(location = 0) out vec4 radiance;
layout(constant_id = 5) const int kMsaa = 1;

#ifdef BN_STAGES
layout(constant_id = 6) const bool kKnowsTriangle = false; // as in the pipeline whose words are recorded
layout(constant_id = 7) const int kGroup = 0;
layout(location = 5) flat in int triangle;
#define BN_TAKE_WORD(at, x)                                                                                                                \
    if ((at) / 4 == kGroup)                                                                                                                \
        radiance[(at) % 4] = x;
#include "shading/surface/recorded.t.h"
#endif

// Returns the samples that survive the alpha test; bit s is sample s.
int alive_samples(int m, real alpha)
{
    bool stays = materials[m].alpha_mode == kAlpha_opaque || alpha_stays(m, alpha, lit(0.5));
    return stays ? (1 << frame.msaa) - 1 : 0;
}

// Returns true where the triangle covers the pixel centre. Tests its edges in homogeneous clip space, exact but for the
// device's own snapping.
bool covers_centre(int number, int px, int py)
{
    // Pixel centre in homogeneous coordinates
    real x = (to_real(px) + lit(0.5)) / frame.half_width - lit(1.0);
    real y = lit(1.0) - (to_real(py) + lit(0.5)) / frame.half_height;
    real3 at = vec3(x, y, 1.0);
    view_params view = view_params_of(frame.view);
    // Corners in clip space
    real3 v[3];
    for (int i = 0; i < 3; ++i) {
        real4 clip = clip_position(vertex_position(bn_ints[places.index_base + 3 * number + i]), view);
        v[i] = vec3(clip.x, clip.y, clip.z); // x, y, w
    }
    // Signs of the three edge functions
    real e0 = k_dot3(k_cross(v[1], v[2]), at);
    real e1 = k_dot3(k_cross(v[2], v[0]), at);
    real e2 = k_dot3(k_cross(v[0], v[1]), at);
    return (e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0) || (e0 <= 0.0 && e1 <= 0.0 && e2 <= 0.0);
}

// Returns the tile renderer's shading position as an offset from the pixel centre, in pixels. The position is the centre if
// the triangle covers it, else the mean of the covered samples. Fragments that do not know their triangle use the mean
// unless all samples are covered.
vec2 shaded_offset(int px, int py)
{
#ifdef BN_CENTROID
    return vec2(0.0);
#else
    int covered = gl_SampleMaskIn[0];
    if (kMsaa == 1 || covered == (1 << kMsaa) - 1)
        return vec2(0.0);
#if defined(BN_STAGES)
    if (kKnowsTriangle && covers_centre(triangle, px, py))
        return vec2(0.0);
#elif defined(BN_PRIMITIVE_ID)
    if (covers_centre(pass.first_triangle + gl_PrimitiveID, px, py))
        return vec2(0.0);
#endif
    sample_mean mean = mean_of_samples(0, covered);
    real2 offset = vec2(float(mean.x - 128), float(mean.y - 128)) * lit(0.00390625);
    return offset;
#endif
}

// Makes the visible point from the interpolated attributes.
visible_point point_of_fragment(int px, int py)
{
    visible_point p;
    p.normal_dx = dFdxFine(normal);
    p.normal_dy = dFdyFine(normal);
    p.uv0_dx = dFdxFine(uv.xy); // between pixel centres, by row and column of the quad
    p.uv1_dx = dFdxFine(uv.zw);
    p.uv0_dy = dFdyFine(uv.xy);
    p.uv1_dy = dFdyFine(uv.zw);
    vec2 offset = shaded_offset(px, py);
    vec4 place = BN_AT_POINT(position);
    // An attribute that is 1 at every vertex comes out as 1 here, unless the device divides by the centre's w, as Mesa 22.3
    // does. So divide by the attribute.
    real w = place.w;
    p.position = place.xyz / w;
    p.normal = BN_AT_POINT(normal) / w;
    vec4 t = BN_AT_POINT(tangent) / w;
    p.tangent = t.xyz;
    p.tangent_sign = t.w < 0.0 ? -1.0 : 1.0;
    p.color = BN_AT_POINT(color) / w;
    vec4 uv_at = BN_AT_POINT(uv) / w;
    p.uv0 = uv_at.xy;
    p.uv1 = uv_at.zw;
    p.front = gl_FrontFacing;
    // Ray through the shading position
    real x = to_real(px) + lit(0.5) + offset.x;
    real y = to_real(py) + lit(0.5) + offset.y;
    p.ray = ray_through(0, view_params_of(frame.view), x, y);
#ifdef BN_CENTROID
    if (frame.view.orthographic == 0) {
        real3 from_eye = p.position - vec3(frame.view.eye[0], frame.view.eye[1], frame.view.eye[2]);
        p.ray = from_eye;
    }
#endif
    return p;
}

parallax_plane plane_of_fragment(visible_point p)
{
    parallax_plane plane;
    plane.along = dFdxFine(position.xyz);
    plane.across = dFdyFine(position.xyz);
    plane.coordinates_along = vec4(p.uv0_dx, p.uv1_dx);
    plane.coordinates_across = vec4(p.uv0_dy, p.uv1_dy);
    return plane;
}

void main()
{
    int m = pass.material, px = int(gl_FragCoord.x), py = int(gl_FragCoord.y) + pass.first_row;
    // Find the visible point and its material
    visible_point p = point_of_fragment(px, py);
    if (materials[m].parallax != 0)
        apply_parallax(0, m, plane_of_fragment(p), p);
    material_inputs at = fetch_material(0, m, p);
    // Drop the samples that fail the alpha test
    int alive = alive_samples(m, at.alpha);
    if (alive == 0)
        discard;
    gl_SampleMask[0] = alive;
#ifdef BN_STAGES
    radiance = vec4(float(triangle & 0xffff), float(triangle >> 16), 0.0, 0.0);
    int word = 4; // group 0 is the triangle
    record_point(word, p, materials[m].uses_color != 0, materials[m].textured != 0, frame.positions != 0);
    record_material(word, at);
#else
    // No sharing: a fragment cannot read its neighbours.
    shared_sample_record light = light_of_fragment(0, m, materials[m].technique, at, lobe_shape_at(0, m, at, p), p, px, py, false);
    radiance = vec4(light.rest, 1.0);
#endif
}
