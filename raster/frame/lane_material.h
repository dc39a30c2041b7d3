// Fetches the material at kLanes visible points. Compiled once, called once per batch.
#pragma once
#include "shading/surface/material.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

BN_STAGE material_inputs fetch_lanes(const ShadingFrame& f, const MaterialRecord& m, const visible_point& p)
{
    return fetch_material(f, m, p);
}

} // namespace BN_ISA_NS
} // namespace burnish
