// Sample lists of the two integrals that a bake spends its time in (bake_fns.h).
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shading/bake/bake_fns.h"
#include "shading/bake/cube_map.h"

namespace burnish {

// GGX samples of one roughness in the frame of the reflected direction (z), for V = N = R; those below the
// horizon left out.
struct PrefilterSamples {
    std::vector<float> x, y, z;      // direction, unit
    std::vector<float> weight;       // n.l / sum of n.l
    std::vector<std::int32_t> level; // of the box chain, the finer of two
    std::vector<float> fraction;     // how far to the next level, [0,1]
    PrefilterInput input(const CubeMap& chain) const;
};

struct PrefilterSample {             // one sample before the horizon test
    double cos_h, n_dot_l, pdf, mip; // pdf of the light direction, 1/sr; mip clamped below `levels`, not to 0
};
// alpha_lin: perceptual roughness, > 0; x2 in [0,1). cube_size, levels: of the box chain.
PrefilterSample prefilter_sample(double alpha_lin, double x2, int samples, int cube_size, int levels);
PrefilterSamples make_prefilter_samples(double alpha_lin, int samples, int cube_size, int levels);

// The cube that irradiance is gathered from: direction times solid angle (the integral of the unit direction
// over the texel), and radiance.
struct IrradianceSource {
    std::vector<float> x, y, z, r, g, b;
    int row = 0; // texels a partial sum
    IrradianceInput input() const;
};
IrradianceSource make_irradiance_source(const CubeLevel& level);

} // namespace burnish
