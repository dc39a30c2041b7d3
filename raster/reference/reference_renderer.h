// The reference: Embree's rays and Monte Carlo integration, the truth that techniques are measured against.
//
// Of every pixel it estimates the mean radiance over the pixel's square (what box resolve tends to), in passes of 64 samples: 16 camera
// positions, and at each what is seen by 4 samples of the light. Passes are independent, so their spread gives the variance of the
// mean. The environment is the specular cube's level 0 as the tile renderer filters it, so that techniques are compared, not maps.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class ReferenceMode : std::int32_t { direct, shadowed, path };
enum class ReferenceStrategy : std::int32_t { mis, brdf, light }; // how directions to the environment are chosen

struct ReferenceOptions {
    ReferenceMode mode = ReferenceMode::direct;
    ReferenceStrategy strategy = ReferenceStrategy::mis;
    int bounces = 8;                  // path: from surface to surface at most
    std::uint64_t samples = 1024;     // a pixel; rounded up to whole passes
    bool area_lights_only = false;    // no light but theirs, and nothing behind the scene
    bool full_textures = false;       // read at full detail wherever a ray meets them, not filtered over a pixel's footprint
    double target_error = 0.0;        // above 0: stop early, once mean_relative_error() is not above it
    std::string checkpoint;           // file; empty: none
    std::string checkpoint_folder;    // in its place: each picture has a file of its own there, checkpoint_of()
    double checkpoint_seconds = 60.0; // between two writes of it
    bool own_checkpoint = false;      // in a folder of ours, where no link is followed
    // Called where the picture is finished and its checkpoint cannot be written; without it that is an error of the picture too.
    std::function<void(const Error&)> lost_checkpoint;
    const std::atomic<bool>* stop = nullptr; // set by another thread or a signal: end soon, keep everything in the checkpoint
    Isa isa = Isa::scalar;                   // never changes the picture on one machine
    bool quiet = true;                       // no progress bar
};

inline constexpr std::uint64_t kMaxReferenceSamples = std::uint64_t{1} << 32; // a pixel

bool reference_available(); // whether this program was built with Embree

// What runs it and how many samples it takes are in Frame::stats.sampling; Frame::variance is the variance of the mean. FrameDesc's
// technique, samples and tile size are not looked at; msaa only for triangle ids.
Result<std::unique_ptr<Renderer>> make_reference_renderer(const RenderInput& input, const ReferenceOptions& options);

// The file of this picture's checkpoint; empty: none.
std::string checkpoint_of(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

// Whether it can be gone on with, or is not there yet: known before any work is done.
Status check_reference_checkpoint(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

} // namespace burnish
