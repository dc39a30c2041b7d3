// Functions that a stage offers to assembly (*.t.h). A stage is lanes in C++ and one invocation in GLSL.
//   frame_ref f, the_frame(f).width...   the frame record (shading/lang/records.h); any_frame f: for a BN_STAGE, compiled once
//   place_of_center(f, view, px, py)     place_on_screen() of a pixel centre; view is the frame's
//   the_light(f, i).position...          light i; i < the_frame(f).light_count
//   light_reach r = lights_reaching(f, position); next_light(f, r)   visits the lights that may reach a place. Lanes visit every light
//                                        whose range covers some lane's place. A result of light_count or more ends the visit.
//   the_area_light(f, i).radiance...     area light i; i < the_frame(f).area_light_count
//   picture_of(f, i)                     texture_desc of that light's picture; the light must have one
//   material_ref m, any_material m, the_material(m).metallic...   a material record
//   texture_used(m, kNormalTex)          true where the material has a texture in this slot
//   texture_fetches t = textures_at(f, m, p)   the material's textures at visible_point p
//   texel_of(t, kNormalTex)              a used texture's value. Call it once per slot: lanes fetch at the call, GLSL has fetched all.
//   texel_beside(f, m, slot, p)          a used texture's value at another point
//   texture_of_frame(f, i)               texture_desc of texture i of the frame, such as the_frame(f).behind
//   texture_desc_of(f, m, slot); texel_at_level(one_level, slot, uv)   a used texture's description, and one texel of it anywhere
//   dfg_pairs(f) lobe_albedo_pairs(f) lobe_slice_pairs(f)   tables for dfg_lookup(), lobe_albedo_lookup(), lobe_slice_lookup()
//   ltc_texels(f)                        the table of linearly transformed cosines, for ltc_lookup()
//   prefiltered_env(f) irradiance_cube(f) mip_env(f)   cubes without extracted lights, for cube_sample() and the sums below
//   full_env(f)                        the environment with its extracted lights; level 0 alone
//   lobe_used(at)                        true where the frame may use lobe number `at` from shading/models.def
//   area_way_used(at)                    true where the frame may use line `at` of BN_AREA_LIGHTS
//   quads_apart()                        true in lanes, which keep the corners of a quad in registers; GLSL has one loop for all polygons
//   transmission_used()                  true where some material may transmit light
//   film_used()                          true where some material may lie under a thin film
//   coating_used(at)                     true where some material may have coating `at` of shading/coatings.def
//   grid_sample(f, i)                    slopes and density of sample i; i < the_frame(f).grid_count (GridSample)
//   grid_of_four(f, first, set)          four values of the set, 0 to 3, that each lane picks from the kPhongBlock samples at `first`
// Sums of weighted cube fetches. Lanes compute some addresses ahead, GLSL fetches one by one; both give the same bits.
//   cube_sum s; cube_sum_begin(s, cube); cube_sum_add(s, direction, cube_sum_levels_at(s, lod, weight)); cube_sum_value(s)
//   cube_terms s; cube_terms_begin(s, cube, trilinear); cube_terms_add(s, direction, lod, colour, weight); cube_terms_value(s)
//   cube_terms_add_level(s, cube, direction, level, colour, weight)   a bilinear fetch from an integer level; for sums without `trilinear`
// Many directions may share the levels and weight of a cube_sum. A cube_terms sum multiplies each fetch by its colour, then
// by its weight; without `trilinear`, cube_terms_add() reads level 0. Directions have any length. A sum refers to its cube
// until the end: pass a variable, not a temporary.
#ifndef BN_STAGE_H
#define BN_STAGE_H

#include "shading/lang/frame.h"

#ifdef __cplusplus
#include "shading/inputs/stage_cxx.h"
#else
#include "shading/inputs/stage.glsl"
#endif

#endif
