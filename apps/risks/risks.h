// Where a picture's inputs lie beyond what the atlas found its technique to hold: `burnish render --risks`.
#pragma once
#include <string>
#include <vector>

#include "apps/risks/entries.h"
#include "core/image/image.h"
#include "raster/session/session.h"

namespace burnish {

// What a technique is given at a pixel, or at the onset of an entry of the atlas.
struct RiskInputs {
    float along = 0.0f, across = 0.0f;     // widths of the lobe, alpha (1 +- eta)
    float n_dot_v = 1.0f;                  // [0,1]
    float tilt = 0.0f;                     // radians
    float samples = 1.0f;                  // of the technique
    float axis_k = 1.0f, axis_beta = 0.0f; // FrameDesc::major_axis_k, major_axis_beta
    float texel = 0.0f;                    // angle of one of the environment, radians
    float separable = 0.0f, fit = 0.0f;    // 1 with --masking separable, --dfg fit
    float alpha() const { return 0.5f * (along + across); }
    float eta() const { return along > 0.0f ? (along - across) / (along + across) : 0.0f; }
    float least_across() const { return across > 1e-3f ? across : 1e-3f; }
};

// What is the same in all of a picture.
RiskInputs inputs_of_frame(const FrameDesc& desc, const Environment& environment);
// Of an entry's failing picture at s; of a picture of its options.
RiskInputs inputs_of_entry(const AtlasEntry& entry, double s);
RiskInputs inputs_of_setting(const RenderOptions& o);

struct RiskFinding {
    std::string technique, entry, says; // of risks.def
    std::string beyond;                 // "anisotropy 0.158", "an eye 11 degrees above the surface": where the path breaks
    double share = 0.0;                 // of the shaded pixels, [0,1]; a pixel may be marked by several
};

struct RiskMap {
    std::vector<RiskFinding> findings; // the most first; those of no pixel are left out
    int width = 0, height = 0;         // of marks: a picture of at most 3600 pixels or so of the same view
    std::vector<std::uint8_t> marks;   // [pixel] 0: not shaded; 1: nothing known; 2 + place in risks.def of what it is furthest beyond
    double share = 0.0;                // of the shaded pixels that anything marks
    double ms = 0.0;
};

// Draws a small picture of what desc shows, with one sample and layers, and looks at that: what desc draws is not touched.
Result<RiskMap> mark_risks(Session& session, const FrameDesc& desc);

// 8-bit RGB: black where nothing is shaded, grey where nothing is known, a colour an entry.
Image risk_picture(const RiskMap& map, int width, int height);
// "7.1 % of shaded pixels: bent_normal beyond anisotropy 0.158 (upside down; bent_normal_bends_too_far)", a line a finding.
std::string risk_lines(const RiskMap& map);

} // namespace burnish
