// From a setup to what shading knows of a visible point: attributes interpolated at the shaded point, and the derivatives of the 2x2 quad
// from the plane equations. The operations and their order are those of raster/tile/fragment.h.
#ifndef BN_FRAGMENT_GLSL
#define BN_FRAGMENT_GLSL

#include "shading/stages/interface.glsl"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/interpolate.k.h"
#include "shading/surface/coverage.t.h"
#include "shading/surface/surface.k.h"

struct triangle_setup {
    ivec3 x, y, vertex;
    real3 inv_w;
    int info;
    real3 unclip0, unclip1, unclip2;
};

triangle_setup load_setup(int slot)
{
    triangle_setup t;
    t.x = ivec3(setups[slot].x[0], setups[slot].x[1], setups[slot].x[2]);
    t.y = ivec3(setups[slot].y[0], setups[slot].y[1], setups[slot].y[2]);
    t.vertex = ivec3(setups[slot].vertex[0], setups[slot].vertex[1], setups[slot].vertex[2]);
    t.inv_w = vec3(setups[slot].inv_w[0], setups[slot].inv_w[1], setups[slot].inv_w[2]);
    t.info = setups[slot].info;
    t.unclip0 = vec3(setups[slot].bary[0], setups[slot].bary[1], setups[slot].bary[2]);
    t.unclip1 = vec3(setups[slot].bary[3], setups[slot].bary[4], setups[slot].bary[5]);
    t.unclip2 = vec3(setups[slot].bary[6], setups[slot].bary[7], setups[slot].bary[8]);
    return t;
}

// Weights of the whole triangle's vertices at a point, 1/256 pixel.
bary_weights weights_at(triangle_setup t, int x, int y)
{
    bary_weights w = perspective_weights(vec3(to_real(t.x.x - x), to_real(t.x.y - x), to_real(t.x.z - x)),
                                         vec3(to_real(t.y.x - y), to_real(t.y.y - y), to_real(t.y.z - y)), t.inv_w);
    if ((t.info & kGpuClipped) != 0)
        w.b = unclip_weights(w.b, t.unclip0, t.unclip1, t.unclip2);
    return w;
}

real vertex_word(int vertex, int word) { return bn_reals[places.shading_base + 16 * vertex + word]; }

real blend_word(triangle_setup t, real3 b, int word)
{
    real value = b.x * vertex_word(t.vertex.x, word) + b.y * vertex_word(t.vertex.y, word) + b.z * vertex_word(t.vertex.z, word);
    return value;
}
real3 blend3(triangle_setup t, real3 b, int word)
{
    return vec3(blend_word(t, b, word), blend_word(t, b, word + 1), blend_word(t, b, word + 2));
}
real2 blend2(triangle_setup t, real3 b, int word) { return vec2(blend_word(t, b, word), blend_word(t, b, word + 1)); }

// samples: mask of the covered ones. px, py: pixel in the image.
visible_point point_of(triangle_setup t, int px, int py, int samples)
{
    int material = t.info >> 2;
    int corner_x = (px << 8) - frame.center_x, corner_y = (py << 8) - frame.center_y;
    bary_weights center = weights_at(t, corner_x + 128, corner_y + 128);
    bary_weights w = center;
    ivec2 at = ivec2(corner_x + 128, corner_y + 128);
    if (!center.inside) {
        sample_mean mean = mean_of_samples(0, samples);
        at = ivec2(corner_x + mean.x, corner_y + mean.y);
        w = weights_at(t, at.x, at.y);
    }
    visible_point p;
    p.normal = blend3(t, w.b, 0);
    p.tangent = blend3(t, w.b, 3);
    p.tangent_sign = blend_word(t, w.b, 6) < 0.0 ? -1.0 : 1.0;
    p.front = (t.info & kGpuFrontFacing) != 0;
    real x = to_real(at.x + frame.center_x) * lit(0.00390625);
    real y = to_real(at.y + frame.center_y) * lit(0.00390625);
    p.ray = ray_through(0, view_params_of(frame.view), x, y);
    p.position = vec3(0.0);
    if (frame.light_count > 0) {
        real3 x_of = vec3(vertex_position(t.vertex.x));
        real3 y_of = vec3(vertex_position(t.vertex.y));
        real3 z_of = vec3(vertex_position(t.vertex.z));
        p.position = w.b.x * x_of + w.b.y * y_of + w.b.z * z_of;
    }
    p.color = vec4(0.0);
    if (materials[material].uses_color != 0)
        p.color = vec4(blend3(t, w.b, 12), blend_word(t, w.b, 15));
    for (int i = 0; i < 2; ++i)
        p.uv[i] = p.uv_dx[i] = p.uv_dy[i] = vec2(0.0);
    if (materials[material].textured == 0)
        return p;
    // the other pixel of the quad in x and in y: to the right of or below an even one, to the left of or above an odd one
    int step_x = (px & 1) != 0 ? -256 : 256, step_y = (py & 1) != 0 ? -256 : 256;
    bary_weights wx = weights_at(t, corner_x + 128 + step_x, corner_y + 128);
    bary_weights wy = weights_at(t, corner_x + 128, corner_y + 128 + step_y);
    real sign_x = (px & 1) != 0 ? -1.0 : 1.0;
    real sign_y = (py & 1) != 0 ? -1.0 : 1.0;
    for (int i = 0; i < 2; ++i) {
        p.uv[i] = blend2(t, w.b, 8 + 2 * i);
        real2 here = blend2(t, center.b, 8 + 2 * i);
        p.uv_dx[i] = (blend2(t, wx.b, 8 + 2 * i) - here) * sign_x;
        p.uv_dy[i] = (blend2(t, wy.b, 8 + 2 * i) - here) * sign_y;
    }
    return p;
}

#endif
