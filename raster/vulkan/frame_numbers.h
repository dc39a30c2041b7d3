// Choices that stages are compiled for: techniques and lobes as specialization constants, and integers of the frame's, its materials' and
// its area lights' records.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "raster/vulkan/pipelines.h"
#include "raster/vulkan/prune.h"
#include "shading/lang/records.h"

namespace burnish {

// Values of constant_id 0 and 1 in shading/stages: technique bits, by index in models.def, and lobe bits.
struct Used {
    std::int32_t techniques = 0, lobes = 0;
};

// Collects the frames' lobes, and their techniques that do or do not share samples.
Used used_by(const std::vector<FrameDesc>& frames, bool sharing);
// Returns the constants for a frame plus `others`.
Specialization technique_constants(const std::vector<MaterialRecord>& materials, const FrameRecord& frame, const Used& others);

// Returns the frame's settings, the counts that are 0, and the flags that all materials or all area lights share. Other frames may have
// others. `others`: frames that are to share pipelines; settings in which they differ are left out.
std::vector<KnownNumber> known_numbers(const FrameRecord& frame, const std::vector<MaterialRecord>& materials,
                                       const std::vector<AreaLightRecord>& area_lights = {}, const std::vector<FrameDesc>& others = {});

} // namespace burnish
