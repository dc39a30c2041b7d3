// Triangles (shading/inputs/triangle.h) in GLSL: setups, and vertex words from the flat buffer of reals.
#ifndef BN_TRIANGLE_GLSL
#define BN_TRIANGLE_GLSL

#include "shading/lang/interface.glsl"
#include "shading/kernels/interpolate.k.h"
#include "shading/kernels/visible_point.k.h"

triangle_setup load_setup(int slot)
{
    triangle_setup t;
    for (int k = 0; k < 3; ++k) {
        t.x[k] = setups[slot].x[k];
        t.y[k] = setups[slot].y[k];
        t.vertex[k] = setups[slot].vertex[k];
        t.unclip[k] = vec3(setups[slot].bary[3 * k], setups[slot].bary[3 * k + 1], setups[slot].bary[3 * k + 2]);
    }
    t.inv_w = vec3(setups[slot].inv_w[0], setups[slot].inv_w[1], setups[slot].inv_w[2]);
    t.info = setups[slot].info;
    t.piece = (t.info & kClipped) != 0;
    t.clipped = t.piece;
    return t;
}

real vertex_word(int vertex, int word) { return bn_reals[places.shading_base + 16 * vertex + word]; }

real blend_word(triangle_setup t, real3 b, int word)
{
    real value = b.x * vertex_word(t.vertex[0], word) + b.y * vertex_word(t.vertex[1], word) + b.z * vertex_word(t.vertex[2], word);
    return value;
}
void blend_vertices(int f, triangle_setup t, real3 b, bool all_words, inout vertex_words a)
{
    for (int word = 0; word < (all_words ? 16 : 8); ++word)
        a.at[word] = blend_word(t, b, word);
}
real4 vertex_coordinates(int f, triangle_setup t, int k)
{
    int vertex = t.vertex[k];
    return vec4(vertex_word(vertex, 8), vertex_word(vertex, 9), vertex_word(vertex, 10), vertex_word(vertex, 11));
}
real3 vertex_place(int f, triangle_setup t, int k) { return vertex_position(t.vertex[k]); }

#endif
