// Measures errors and costs of settings for each material of a scene, on a small picture of a frame's view.
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

struct ProbedMaterial {
    double share = 0.0;                  // of the picture's pixels; 0: not seen, or through blended surfaces alone
    double default_cost = 0.0;           // of the default technique, instructions a fragment
    std::vector<ProbedSetting> settings; // empty where the share is 0
};

struct Probe {
    std::vector<ProbedMaterial> materials; // by index in the scene
    int width = 0, height = 0;
    double ms_per_instruction = 0.0; // processor time of this machine; no part of a plan by error
};

// Returns the settings with a measured cost.
std::vector<MaterialTechnique> plannable_settings();

// Draws the view at a quarter to an eighth of the frame's sides, with one sample a pixel, by each setting. The error of a prefiltered
// setting is its distance to the best one, plus the best one's own error. Two noisy pictures by mc tell that error, and the noise of mc.
// The same frame gives the same probe on every machine and number of threads, apart from times. settings: the allowed ones of
// plannable_settings(). Expects a session of the tile renderer.
Result<Probe> probe_frame(Session& session, const FrameDesc& desc, const std::vector<MaterialTechnique>& settings);

} // namespace burnish
