// Hash of everything that a sample depends on. A checkpoint with another key is refused.
#pragma once
#include <cstdint>

#include "raster/frame/frame.h"
#include "raster/reference/reference_renderer.h"

namespace burnish {

// Returns the description with only the fields that samples depend on. All light is sampled as by `mc`; technique, samples, tiles and MSAA
// of rasterizers do not matter.
FrameDesc reference_desc(FrameDesc desc);

// Returns a hash over scene, environment, view and options, without the number of samples and the instruction set.
std::uint64_t reference_key(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

} // namespace burnish
