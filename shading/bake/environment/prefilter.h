// Source data of irradiance in the form that lane code reads (bake_fns.h).
#pragma once
#include <vector>

#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {

// The cube that irradiance reads: radiance, and direction times solid angle (the integral of the unit direction over the texel).
struct IrradianceSource {
    std::vector<float> x, y, z, r, g, b;
    int row = 0; // texels per partial sum
    IrradianceInput input() const;
};
IrradianceSource make_irradiance_source(const CubeLevel& level);

} // namespace burnish
