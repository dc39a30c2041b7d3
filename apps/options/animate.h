// Pictures in a row: options that go from one value to another, step by step.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "raster/frame/frame.h"

namespace burnish {

// An option whose numbers go from one value to another, along a straight line or by equal factors.
struct OptionPath {
    std::string option; // "--roughness"
    std::vector<double> from, to;
    bool whole = false;     // whole numbers only: the nearest
    bool geometric = false; // by factors: no number is 0 or changes its sign
};

// `text`: NAME=FROM:TO, several by commas; a value of more numbers has commas of its own: "eye=0,0,3:1,0,3,fov=40:20". Each name is that of
// a picture option that takes numbers, without its dashes; both ends are tried on `table`, whose rows keep the last value tried.
Result<std::vector<OptionPath>> parse_option_paths(const std::string& option, const std::string& text, OptionTable& table);

// The value at t in [0,1], as one would write it.
std::string value_at(const OptionPath& path, double t);

// Once around the scene, `count` views: from `first_deg` (azimuth, elevation) on, at one distance from which each of them has the scene in
// the picture.
std::vector<View> turntable_views(const DrawTables& tables, const FrameDesc& frame, const glm::vec2& first_deg, float fov_y_rad, int count);

} // namespace burnish
