// Input and output of the reference renderer's lane code: plain data, shared by baseline code and instruction-set objects.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/rays/ray_scene.h"
#include "raster/reference/environment_sampler.h"
#include "raster/reference/reference_renderer.h"
#include "raster/reference/sobol.h"
#include "shading/lang/tables.h"

namespace burnish {

// Everything that a sample depends on; constant within a picture.
struct ReferenceParams : ShadingFrame {
    std::int32_t any_alpha; // some material transmits light
    bool solid_lights;      // some area light is solid
    float ray_epsilon;      // metres; added to the rounding error of coordinates
    EnvironmentSamplerView sampler;
    ReferenceMode mode;
    ReferenceStrategy strategy;
    std::int32_t bounces; // between surfaces, path mode only
    bool full_textures, lights_only;
    std::int32_t shades; // light samples at each camera position, 1..kPassShades
    const SobolTable* sobol;
    const RayScene* rays;
    void (*trace)(const RayScene& scene, RayPacket& rays, RayKind kind);
};

struct PixelState { // over all passes so far: Welford's mean and sum of squared differences per channel
    double mean[3], m2[3];
};

struct RayCount {
    std::uint64_t rays, ticks, all_ticks; // time stamp counter ticks: inside Embree, and in total
};

struct ReferenceScratch { // of one worker
    RayPacket packet;
    RayCount count;
};

struct PixelBlock {
    std::int32_t x0, y0, width, height;
    std::uint32_t first_pass, passes;
};

struct ReferenceFns { // one table per instruction set
    // Adds passes to a block's pixels. `state` covers the whole picture.
    void (*add_passes)(const ReferenceParams&, const PixelBlock&, ReferenceScratch&, PixelState* state);
    // Traces the sample positions in one pixel row. Writes ids[pixel][sample], the solid triangles' global ids, and the transmittance of
    // blended surfaces before them, [0,1]; through may be null.
    void (*trace_row)(const ReferenceParams&, int y, const SamplePattern&, ReferenceScratch&, std::uint32_t* ids, float* through);
};
BN_DECLARE_FNS(ReferenceFns);

} // namespace burnish
