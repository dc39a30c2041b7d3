// What a sample depends on, as one number: a checkpoint of anything else is refused.
#pragma once
#include <cstdint>

#include "raster/frame/frame.h"
#include "raster/reference/reference_renderer.h"

namespace burnish {

// What a sample depends on of a frame: all light is sampled as by `mc`, and the technique, samples, tiles and MSAA that rasterizers are
// asked for do not matter.
FrameDesc reference_desc(FrameDesc desc);

// Scene, environment, view and options; not how many samples, and not what runs them.
std::uint64_t reference_key(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

} // namespace burnish
