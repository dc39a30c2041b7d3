// What assembly may ask of the triangles that its fragments are of; stage.h knows the rest.
//   triangle_ref t                          has the members of a triangle_setup
//   blend_vertices(f, t, b, all_words, a)   the words of its vertices (DrawTables::shading), weighted by b, to vertex_words a: the first 8,
//                                           or all 16
//   vertex_coordinates(f, t, k)             words 8 to 11 of its vertex k: both sets of texture coordinates
//   vertex_place(f, t, k)                   of its vertex k, world space, metres
// In C++ who includes assembly has them.
#ifndef BN_TRIANGLE_H
#define BN_TRIANGLE_H

#ifdef __cplusplus
#define triangle_ref const auto&
#else
#include "shading/stages/triangle.glsl"
#define triangle_ref triangle_setup
#endif

#endif
