// Picture sequences: options that run from one value to another, step by step, and turntable views.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "raster/frame/frame.h"

namespace burnish {

// An option whose numbers run from one value to another, linearly or geometrically.
struct OptionPath {
    std::string option; // "--roughness"
    std::vector<double> from, to;
    bool whole = false;     // rounds to the nearest whole number
    bool geometric = false; // interpolates by equal factors; no number is 0 or changes sign
};

// Reads `text`: one or more NAME=FROM:TO, with commas between. A vector value has commas too, as in "eye=0,0,3:1,0,3,fov=40:20".
// NAME is a numeric picture option without dashes. Both ends are tried on `table`, whose rows keep the last value tried.
Result<std::vector<OptionPath>> parse_option_paths(const std::string& option, const std::string& text, OptionTable& table);

// Returns the value at t in [0,1], as a command line would hold the value.
std::string value_at(const OptionPath& path, double t);

// Returns `count` views on a circle around the scene, starting at `first_deg` (azimuth, elevation). All views keep one distance, large
// enough for each view to show the whole scene.
std::vector<View> turntable_views(const DrawTables& tables, const FrameDesc& frame, const glm::vec2& first_deg, float fov_y_rad, int count);

} // namespace burnish
