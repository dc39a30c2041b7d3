// Access to the frame and material records: the part of the stage (stage.h) that needs neither tables nor textures.
#ifndef BN_FRAME_H
#define BN_FRAME_H

#ifdef __cplusplus
#include "shading/lang/lang.h"
#include "shading/lang/tables.h"

// Any type with the members of ShadingFrame or MaterialRecord. A derived type may fix some members to compile-time
// constants.
#define frame_ref const auto&
#define any_frame const ShadingFrame&
#define material_ref const auto&
#define any_material const MaterialRecord&

namespace burnish {
inline namespace BN_ISA_NS {

BN_FN real3 splat3(const float* v)
{
    return vec3_of(splat(v[0]), splat(v[1]), splat(v[2]));
}

BN_FN const auto& the_frame(frame_ref f)
{
    return f;
}
BN_FN const auto& the_material(material_ref m)
{
    return m;
}

} // namespace BN_ISA_NS
} // namespace burnish
#else
#include "shading/lang/interface.glsl"

#define frame_ref int // there is one frame
#define any_frame int
#define material_ref int
#define any_material int
#define the_frame(f) frame
#define the_material(m) materials[m]
#define splat3(v) vec3((v)[0], (v)[1], (v)[2])
#endif

#endif
