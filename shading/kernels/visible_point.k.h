// Geometry at a visible point, and its interpolation. shading/visible_point.def lists the values.
#ifndef BN_VISIBLE_POINT_K_H
#define BN_VISIBLE_POINT_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct visible_point {
#define BN_POINT(type, words, name, asked) type name;
#define BN_INTERPOLATED(type, words, name, asked, first) type name;
#include "shading/visible_point.def"
    real3 normal_dx, normal_dy; // change of `normal` per pixel, right and down; only where point_of() gets `bends`; never recorded
};

struct vertex_words { // words of a vertex (DrawTables::shading), or a blend of several
    real at[16];
};

BN_FN real real_of_words(BN_IN(vertex_words) a, int first)
{
    return a.at[first];
}
BN_FN real2 real2_of_words(BN_IN(vertex_words) a, int first)
{
    return vec2_of(a.at[first], a.at[first + 1]);
}
BN_FN real3 real3_of_words(BN_IN(vertex_words) a, int first)
{
    return vec3_of(a.at[first], a.at[first + 1], a.at[first + 2]);
}
BN_FN real4 real4_of_words(BN_IN(vertex_words) a, int first)
{
    return vec4_of(a.at[first], a.at[first + 1], a.at[first + 2], a.at[first + 3]);
}

// Fills the requested interpolated members of p. Reads a's upper half only for colours and textures.
BN_FN void set_interpolants(BN_IN(vertex_words) a, bool uses_color, bool textured, BN_INOUT(visible_point) p)
{
#define BN_POINT(type, words, name, asked)
#define BN_INTERPOLATED(type, words, name, asked, first)                                                                                   \
    if (asked)                                                                                                                             \
        p.name = type##_of_words(a, first);
#include "shading/visible_point.def"
    p.tangent_sign = select(p.tangent_sign < lit(0.0), lit(-1.0), lit(1.0));
}

BN_KERNELS_END

#endif
