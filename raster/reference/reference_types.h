// What the lanes of the reference renderer read and write: plain data, shared by the baseline code and the instruction-set objects.
#pragma once
#include <cstdint>

#include "raster/frame/records.h"
#include "raster/reference/environment_sampler.h"
#include "raster/reference/ray_scene.h"
#include "raster/reference/sobol.h"

namespace burnish {

enum class ReferenceMode : std::int32_t { direct, shadowed, path };
enum class ReferenceStrategy : std::int32_t { mis, brdf, light }; // how directions to the environment are chosen

// Everything that a sample depends on; constant while a picture is made.
struct ReferenceParams {
    ViewParams view;
    std::int32_t width, height;
    float half_width, half_height; // pixels
    // scene
    const float *px, *py, *pz;     // world space, metres
    const float* shading_vertices; // DrawTables::shading as floats
    const std::uint32_t* indices;
    const std::uint32_t* triangle_material;
    const MaterialRecord* materials;
    const LightRecord* lights;
    std::int32_t light_count;
    std::int32_t any_alpha;        // some material lets light through
    float ray_epsilon;             // metres; added to what the size of a coordinate asks for
    // environment
    CubeParams specular_cube;
    EnvironmentSamplerView sampler;
    const std::uint16_t* dfg_texels;
    const std::uint16_t* lobe_albedo_texels; // only with energy_compensation
    std::int32_t lobe_albedo_size;
    std::int32_t dfg_size, dfg_fit, energy_compensation, horizon;
    std::int32_t background;
    std::int32_t texture_taps, override_anisotropy; // read by raster/frame/lane_material.h
    float anisotropy;
    float tilt_cos[2], tilt_sin[2];
    std::int32_t tilted;           // any tilt at all
    // integration
    ReferenceMode mode;
    ReferenceStrategy strategy;
    std::int32_t bounces;          // from surface to surface, path only
    std::uint32_t seed;
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
    // Global ids of the triangles behind sample positions of one row of pixels: ids[pixel][sample].
    void (*trace_row)(const ReferenceParams&, int y, const SamplePattern&, ReferenceScratch&, std::uint32_t* ids);
};

} // namespace burnish
