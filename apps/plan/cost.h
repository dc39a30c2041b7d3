// Costs of techniques' settings, in counted instructions: equal on every machine.
#pragma once
#include <string>
#include <vector>

#include "apps/plan/probe.h"
#include "raster/frame/frame.h"

namespace burnish {

struct PlanCost { // a line of costs.def
    std::string technique;
    int samples;
    bool line;            // the fragment's lobe decides on the samples
    double fixed, sample; // instructions a fragment, and a sample more
};
const std::vector<PlanCost>& plan_costs();

struct AreaLightsCost {         // a line of costs.def
    int way, samples;           // as AreaLightsSetting
    double fixed, quad, sample; // instructions a fragment, a quad more, and a sample more on each quad
};
const std::vector<AreaLightsCost>& area_lights_costs();

// Returns the instructions a fragment of a method for this many area lights. A method without a line costs as the first one.
double area_lights_cost(const AreaLightsSetting& setting, std::size_t lights);

// Lobes at the pixels of a picture.
struct PixelLobes {
    struct Lobe {
        float o[3]; // to the eye, in the lobe's frame: along, across, normal
        float sigma_u, sigma_v;
    };
    std::vector<Lobe> of; // [pixel]
};
// frame: drawn by desc with layers.
PixelLobes lobes_of(const Frame& frame, const FrameDesc& desc);

// Returns the instructions a fragment of mc with this many samples, less the instructions of a single fetch.
double random_over_fetch(int samples);

// Returns the mean cost over each material's pixels, instructions a fragment. material: of each pixel, below `count`, or negative.
std::vector<double> mean_costs(const MaterialTechnique& setting, const PixelLobes& lobes, const std::vector<int>& material,
                               std::size_t count);

} // namespace burnish
