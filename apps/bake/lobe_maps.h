// Makes maps of lobes from heights: the widths, directions and tilts of the microgeometry.
#pragma once
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "shading/bake/tables/slope_lobe.h"

namespace burnish {

struct LobeMaps {     // floats, 3 channels
    Image roughness;  // red and green: widths along the stretched highlight and across it
    Image rotation;   // red and green: the highlight's direction along tangent and bitangent
    Image normal;     // the lobes' normals
    SlopeLobe middle; // the lobe with the median distance
    int clamped = 0;  // lobes wider than 1
};

inline constexpr int kLeastHeights = 16; // of a lobe, along each side

// Fits a lobe to each part of a height map. Heights repeat and lie in red, [0,1]. depth: of height 0, in texture lengths. width, height:
// of the maps, lobes. Errors: ExitCode::usage for parts with fewer than kLeastHeights texels along a side.
Result<LobeMaps> lobe_maps(const Image& heights, double depth, int width, int height, SlopeModel model, const Jobs& jobs);

} // namespace burnish
