// The input and output for the reference renderer's lane code: plain data, shared by baseline code and instruction-set objects.
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

struct PixelState { // over some passes: mean and sum of squared differences from the mean, per channel
    double mean[3], m2[3];
};

// Merges two pass sets' states (Chan, Golub and LeVeque 1979, "Updating formulae and a pairwise algorithm for computing sample
// variances").
static inline __attribute__((always_inline)) PixelState merged(const PixelState& a, double passes_a, const PixelState& b, double passes_b)
{
    const double passes = passes_a + passes_b;
    PixelState r;
    for (int c = 0; c < 3; ++c) {
        const double delta = b.mean[c] - a.mean[c];
        r.mean[c] = a.mean[c] + delta * (passes_b / passes);
        r.m2[c] = a.m2[c] + b.m2[c] + delta * delta * (passes_a * passes_b / passes);
    }
    return r;
}

inline constexpr int kMostSums = 32; // a pass count's bits

// Adds the next 2^k passes' state to a pixel's partial sums. Passes form a binary tree: sums[k] holds 2^k passes where `passes` has bit k
// set, and two sums with equal sizes become the next one. So a picture's bits do not depend on who made which 2^k passes. passes:
// in the sums so far, a multiple of 2^k.
static inline __attribute__((always_inline)) void add_sum(PixelState* sums, std::uint32_t passes, int k, PixelState next)
{
    for (; passes >> k & 1u; ++k)
        next = merged(sums[k], static_cast<double>(1u << k), next, static_cast<double>(1u << k));
    sums[k] = next;
}

struct RayCount {
    std::uint64_t rays, ticks, all_ticks; // time stamp counter ticks: inside Embree, and in total
};

struct ReferenceScratch { // one worker's
    RayPacket packet;
    RayCount count;
};

// Merges a pixel's partial sums, from the last passes to the first.
static inline __attribute__((always_inline)) PixelState total_of_sums(const PixelState* sums, std::uint32_t passes)
{
    PixelState total = {};
    std::uint32_t merged_passes = 0;
    for (int k = 0; k < kMostSums; ++k) {
        if (!(passes >> k & 1u))
            continue;
        total = merged_passes ? merged(sums[k], static_cast<double>(1u << k), total, static_cast<double>(merged_passes)) : sums[k];
        merged_passes += 1u << k;
    }
    return total;
}

struct PixelBlock {
    std::int32_t x0, y0, width, height;
    std::size_t first_pixel;        // the columns', row-major
    std::uint32_t first_pass, done; // the sums' first pass, and how many they hold
    std::uint32_t passes;           // to add
    PixelState* totals;             // a column with all pixels: takes the pixels' totals in place of their sums; null: sums are kept
};

struct ReferenceFns { // one table per instruction set
    // Adds passes to a block's pixels. sums: a pixel column, from first_pixel on, for each bit that is set in the block's passes,
    // before or, without totals, afterwards.
    void (*add_passes)(const ReferenceParams&, const PixelBlock&, ReferenceScratch&, PixelState* const* sums);
    // Traces the sample positions in one pixel row. Writes ids[pixel][sample], the solid triangles' global ids, and the transmittance of
    // blended surfaces before them, [0,1]; through may be null.
    void (*trace_row)(const ReferenceParams&, int y, const SamplePattern&, ReferenceScratch&, std::uint32_t* ids, float* through);
};
BN_DECLARE_FNS(ReferenceFns);

} // namespace burnish
