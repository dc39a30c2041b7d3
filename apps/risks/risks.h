// Finds pixels with inputs beyond the validated range of a technique: `burnish render --risks`.
#pragma once
#include <string>
#include <vector>

#include "apps/options/options.h"
#include "core/image/image.h"
#include "raster/session/session.h"

namespace burnish {

// Inputs of a technique at a pixel, or at the onset of a failure.
struct RiskInputs {
    float along = 0.0f, across = 0.0f;     // lobe widths, alpha (1 +- eta)
    float n_dot_v = 1.0f;                  // [0,1]
    float tilt = 0.0f;                     // radians
    float samples = 1.0f;                  // the technique's
    float axis_k = 1.0f, axis_beta = 0.0f; // FrameDesc::major_axis_k, major_axis_beta
    float texel = 0.0f;                    // angle of one environment texel, radians
    float separable = 0.0f, fit = 0.0f;    // 1 with --masking separable, --dfg fit
    float alpha() const { return 0.5f * (along + across); }
    float eta() const { return along > 0.0f ? (along - across) / (along + across) : 0.0f; }
    float least_across() const { return across > 1e-3f ? across : 1e-3f; }
};

// Returns the inputs common to a whole picture.
RiskInputs inputs_of_frame(const FrameDesc& desc, const Environment& environment);
// Returns the inputs for a picture with these options.
RiskInputs inputs_of_setting(const RenderOptions& o);

struct RiskFinding {
    std::string technique, entry, says; // from risks.def
    std::string beyond;                 // onset on the path: "anisotropy 0.158", "seen from lower than 11 degrees above the surface"
    std::string colour;                 // in the picture: "lime #46ff8b"
    double share = 0.0;                 // over the shaded pixels, [0,1]; a pixel may have several findings
};

struct RiskMap {
    std::vector<RiskFinding> findings; // the most frequent first; findings without pixels are left out
    int width = 0, height = 0;         // a small picture of the same view: about 3600 pixels, or one in 16 x 16
    std::vector<std::uint8_t> marks;   // [pixel] 0: not shaded; 1: no finding; 2 + index in risks.def of the largest excess
    double share = 0.0;                // share of the shaded pixels with a finding
    double ms = 0.0;
};

// Draws a small picture of desc's view, with one sample and layers, and marks its pixels. Does not touch desc's own picture.
Result<RiskMap> mark_risks(Session& session, const FrameDesc& desc);

// Returns 8-bit RGB: black without a surface, grey without a finding, one colour an entry.
Image risk_picture(const RiskMap& map, int width, int height);
// Formats a line a finding: "red #ff4646, 7.1 % of shaded pixels: bent_normal past its limit, anisotropy 0.158 (upside down;
// bent_normal_bends_too_far)".
std::string risk_lines(const RiskMap& map);

} // namespace burnish
