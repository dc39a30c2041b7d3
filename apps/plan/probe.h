// Measures settings' errors and costs for each scene material, on a small picture with a frame's view.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raster/session/session.h"

namespace burnish {

struct ProbedSetting {
    MaterialTechnique setting;
    double error = 0.0; // mean HDR-FLIP over the material's pixels, [0,1]
    double cost = 0.0;  // instructions a fragment, shading by AVX2; see costs.def
};

struct AreaLightsSetting { // FrameDesc::area_way and light_samples
    int way = 0;
    int samples = 1; // on each light, for methods that take samples
};

struct ProbedAreaLights { // a method for all area lights
    AreaLightsSetting setting;
    double cost = 0.0;           // instructions a fragment, shading by AVX2; see costs.def
    std::vector<double> error;   // mean HDR-FLIP over the pixels of each material, [0,1]
    std::vector<float> of_pixel; // [pixel] HDR-FLIP; empty unless asked for
};

struct ProbedMaterial {
    double share = 0.0;                  // share in the picture's pixels; 0: not seen, or through blended surfaces alone
    double default_cost = 0.0;           // the default technique's, instructions a fragment
    std::vector<ProbedSetting> settings; // empty where the share is 0
};

// Predicted errors of single pixels, HDR-FLIP, for the tail of the picture's errors.
struct PixelErrors {
    std::vector<int> material;             // of each probe pixel; below 0: none, and no error
    std::vector<std::vector<float>> error; // [setting][pixel]; settings as in ProbedMaterial
};

struct Probe {
    std::vector<ProbedMaterial> materials;     // by index in the scene
    std::vector<ProbedAreaLights> area_lights; // empty where no area light gives light
    PixelErrors pixels;
    int width = 0, height = 0;
    double ms_per_instruction = 0.0; // processor time on this machine; plans by error leave this out
};

// Return the settings with a measured cost.
std::vector<MaterialTechnique> plannable_settings();
std::vector<AreaLightsSetting> plannable_area_lights();

// Draws the view at a quarter to an eighth of the frame's sides, with one sample a pixel, by each setting. A prefiltered setting's
// error is its distance to the best one, plus the best one's own error. Two noisy pictures by mc tell that error, and mc's noise. A
// pixel's part of the own error follows the pixel's distance to a single fetch. Settings' errors are those of light from the environment.
// Where area lights give light, two pictures by points on the lights tell the errors of methods for them.
// A body of glass has no setting of mc, which samples one interface, unless only such settings are allowed.
// The same frame gives the same probe on every machine and with any thread count, apart from times. settings: the allowed ones of
// plannable_settings(); area_lights: likewise. by_pixel: fills Probe::pixels. Expects a tile renderer's session.
Result<Probe> probe_frame(Session& session, const FrameDesc& desc, const std::vector<MaterialTechnique>& settings,
                          const std::vector<AreaLightsSetting>& area_lights, bool by_pixel);

} // namespace burnish
