// Functions that assembly may call for the triangle under its fragments; stage.h has the others.
//   triangle_ref t                          has the members of a triangle_setup
//   blend_vertices(f, t, b, all_words, a)   blends the vertices' words (DrawTables::shading) by weights b into vertex_words
//   a: the first 8,
//                                           or all 16
//   vertex_coordinates(f, t, k)             words 8 to 11 of vertex k: both sets of texture coordinates
//   vertex_place(f, t, k)                   position of vertex k, world space, metres
// In C++, the file that includes assembly defines these functions.
#ifndef BN_TRIANGLE_H
#define BN_TRIANGLE_H

#ifdef __cplusplus
#define triangle_ref const auto&
#else
#include "shading/inputs/triangle.glsl"
#define triangle_ref triangle_setup
#endif

#endif
