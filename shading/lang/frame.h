// The records of a frame and of its materials, that part of the stage (stage.h) which needs neither tables nor textures.
#ifndef BN_FRAME_H
#define BN_FRAME_H

#ifdef __cplusplus
#include "shading/lang/lang.h"
#include "shading/lang/tables.h"

// Whatever has the members of a ShadingFrame, a MaterialRecord: a type derived of it may give some of them values that the compiler knows.
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
#include "shading/stages/interface.glsl"

#define frame_ref int // of the only one
#define any_frame int
#define material_ref int
#define any_material int
#define the_frame(f) frame
#define the_material(m) materials[m]
#define splat3(v) vec3((v)[0], (v)[1], (v)[2])
#endif

#endif
