// What assembly (*.t.h) may ask of the stage that it runs in: lanes in C++, an invocation in GLSL.
//   frame_ref f, the_frame(f).width...   the frame's record (shading/lang/records.h); any_frame f: of a BN_STAGE, compiled once for all
//   place_of_center(f, view, px, py)     place_on_screen() of a pixel's centre; view is the frame's
//   the_light(f, i).position...          light i of the_frame(f).light_count
//   light_reach r = lights_reaching(f, position); next_light(f, r)   the lights, in turn, that may reach a place: those of lanes are the
//                                        ones in whose range some lane's place is; light_count or more: there is none left
//   the_area_light(f, i).radiance...     area light i of the_frame(f).area_light_count
//   picture_of(f, i)                     texture_desc of its picture, where it has one
//   material_ref m, any_material m, the_material(m).metallic...   a material's record; texture_used(m, kNormalTex)
//   texture_fetches t = textures_at(f, m, p); texel_of(t, kNormalTex)   what its textures, where they are used, hold at a visible_point:
//                                        to be asked for once each, as lanes fetch then and GLSL has fetched all
//   texel_beside(f, m, slot, p)          a slot's texture, where it is used, at another point
//   texture_desc_of(f, m, slot); texel_at_level(one_level, slot, uv)   a slot's texture, where it is used, and a texel of it, anywhere
//   dfg_pairs(f) lobe_albedo_pairs(f) lobe_slice_pairs(f)   tables for dfg_lookup(), lobe_albedo_lookup(), lobe_slice_lookup()
//   ltc_texels(f)                        of the table of transformed cosines, for ltc_lookup()
//   specular_cube(f) irradiance_cube(f) box_cube(f)   cubes, for cube_sample() and the sums below
//   whole_cube(f)                        the environment with its key lights, which the others leave out; level 0 alone
//   lobe_used(at)                        whether the lobe at this place of shading/models.def may be met at all
//   area_way_used(at)                    the same of a way of area lights, BN_AREA_LIGHTS
//   coats_used()                         whether any material may have a clear coat
//   grid_sample(f, i)                    slopes and density of sample i of the_frame(f).grid_count (GridSample)
//   grid_of_four(f, first, set)          of four sets of samples, of which each lane has one: what kPhongBlock samples from `first` on hold
// Sums of weighted fetches from a cube, which lanes plan some addresses ahead and GLSL takes one after the other; same bits.
//   cube_sum s; cube_sum_begin(s, cube); cube_sum_add(s, direction, cube_sum_levels_at(s, lod, weight)); cube_sum_value(s)
//   cube_terms s; cube_terms_begin(s, cube, trilinear); cube_terms_add(s, direction, lod, colour, weight); cube_terms_value(s)
//   cube_terms_add_level(s, cube, direction, level, colour, weight)   a bilinear fetch of an integer level, of a sum without `trilinear`
// Levels and weight of a cube_sum may be found once for many directions. Terms are each multiplied by their colour, then by their weight;
// without `trilinear` they are of level 0. Directions are of any length. A sum needs its cube to the end: a variable, not a value.
#ifndef BN_STAGE_H
#define BN_STAGE_H

#include "shading/lang/frame.h"

#ifdef __cplusplus
#include "shading/lang/stage_cxx.h"
#else
#include "shading/stages/stage.glsl"
#endif

#endif
