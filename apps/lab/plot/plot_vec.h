// Converts plot vectors to kernel vectors, in files compiled in double precision (bn_oracle_objects).
#pragma once
#include "apps/lab/plot/shapes.h"
#include "shading/lang/lang.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline real3 of(const PlotVec& v)
{
    return vec3_of(v.x, v.y, v.z);
}

inline PlotVec to(real3 v)
{
    return {v.x, v.y, v.z};
}

} // namespace BN_ISA_NS
} // namespace burnish
