// What the lanes of the reference renderer read and write: plain data, shared by the baseline code and the instruction-set objects.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/reference/environment_sampler.h"
#include "raster/reference/ray_scene.h"
#include "raster/reference/reference_renderer.h"
#include "raster/reference/sobol.h"
#include "shading/lang/tables.h"

namespace burnish {

// Everything that a sample depends on; constant while a picture is made.
struct ReferenceParams : ShadingFrame {
    std::int32_t any_alpha; // some material lets light through
    float ray_epsilon;      // metres; added to what the size of a coordinate asks for
    EnvironmentSamplerView sampler;
    ReferenceMode mode;
    ReferenceStrategy strategy;
    std::int32_t bounces; // from surface to surface, path only
    bool full_textures, area_lights_only;
    const SobolTable* sobol;
    const RayScene* rays;
    void (*trace)(const RayScene& scene, RayPacket& rays, RayKind kind);
};

struct PixelState { // of all passes so far: Welford's mean and sum of squared differences, a channel each
    double mean[3], m2[3];
};

struct RayCount {
    std::uint64_t rays, ticks, all_ticks; // ticks of the time stamp counter: inside Embree, and of all work
};

struct ReferenceScratch { // of one worker
    RayPacket packet;
    RayCount count;
};

struct PixelBlock {
    std::int32_t x0, y0, width, height;
    std::uint32_t first_pass, passes;
};

struct ReferenceFns { // one table an instruction set
    // Adds passes to the pixels of a block; `state` is the whole picture's.
    void (*add_passes)(const ReferenceParams&, const PixelBlock&, ReferenceScratch&, PixelState* state);
    // Global ids of the solid triangles behind sample positions of one row of pixels, ids[pixel][sample], and what blended ones before them
    // let through, [0,1]; through may be null.
    void (*trace_row)(const ReferenceParams&, int y, const SamplePattern&, ReferenceScratch&, std::uint32_t* ids, float* through);
};
BN_DECLARE_FNS(ReferenceFns);

} // namespace burnish
