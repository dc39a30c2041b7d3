// Integers of a frame's record, and of all its materials' and area lights' records, that stages branch on.
#pragma once
#include <vector>

#include "raster/vulkan/prune.h"
#include "shading/lang/records.h"

namespace burnish {

// Returns the frame's settings, the counts that are 0, and the flags that all materials or all area lights share. Other frames may have
// others.
std::vector<KnownNumber> known_numbers(const FrameRecord& frame, const std::vector<MaterialRecord>& materials,
                                       const std::vector<AreaLightRecord>& area_lights = {});

} // namespace burnish
