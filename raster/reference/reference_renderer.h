// The reference renderer: Embree's rays and Monte Carlo integration. Techniques are measured against its pictures.
//
// It estimates every pixel's mean radiance over the pixel's square (the limit of a box resolve), in passes of 64 samples: 16 camera
// positions with 4 light samples each. Passes are independent, so their spread gives the mean's variance. The environment is the
// specular cube's level 0 with the tile renderer's filter, so that comparisons show techniques, not maps.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class ReferenceMode : std::int32_t { direct, shadowed, path };
enum class ReferenceStrategy : std::int32_t { mis, brdf, light }; // choice of directions to the environment

// A part of a picture: some passes of blocks of 8x8 pixels, in rows from the top left. Parts put together in order of their passes give the
// bits of a picture that one process makes.
struct ReferencePart {
    std::uint32_t first = 0, count = 0;            // blocks to integrate, without a picture in the frame; count 0: all
    std::uint64_t key = 0;                         // the picture's reference_key() where it is known; else 0
    std::uint32_t first_pass = 0;                  // of a pixel; a multiple of the least power of two that is not below its passes
    std::uint64_t samples = 0;                     // a pixel, in place of ReferenceOptions::samples; 0: those
    std::vector<std::uint8_t> made;                // filled by Renderer::render(): the blocks' state
    std::vector<std::vector<std::uint8_t>> others; // states from other processes, taken over before integration
};
std::uint32_t reference_blocks(int width, int height);             // of a picture
std::uint64_t reference_passes(std::uint64_t samples, int shades); // that give a pixel at least so many samples

struct ReferenceOptions {
    ReferenceMode mode = ReferenceMode::direct;
    ReferenceStrategy strategy = ReferenceStrategy::mis;
    int bounces = 8;                     // path mode: most bounces between surfaces
    std::uint64_t samples = 1024;        // per pixel; rounded up to whole passes
    bool own_rays = false;               // by a tree of our own, not Embree's
    bool ids_only = false;               // triangle ids alone: no light, and no colour
    bool area_lights_only = false;       // no other light, and a black background
    bool lamps_only = false;             // punctual lights alone, and extracted lights as points; a black background
    int shades = 4;                      // light samples at each of a pass's 16 camera positions, 1 to 4
    bool full_textures = false;          // textures at full detail, not filtered over a pixel's footprint
    std::shared_ptr<ReferencePart> part; // what each render() integrates; null: the whole picture
    double target_error = 0.0;           // above 0: stop early, once mean_relative_error() is not above it
    std::string checkpoint;              // file; empty: none
    std::string checkpoint_folder;       // replaces `checkpoint`: a file per picture in this folder, checkpoint_of()
    double checkpoint_seconds = 60.0;    // between two writes
    bool own_checkpoint = false;         // the folder is ours: follow no link in it
    // Called if the picture is finished but its checkpoint cannot be written. Without this function the failure is the picture's error.
    std::function<void(const Error&)> lost_checkpoint;
    const std::atomic<bool>* stop = nullptr; // set by another thread or a signal: end soon, keep all work in the checkpoint
    Isa isa = {};                            // never changes the picture on one machine
    bool quiet = true;                       // no progress bar
};

inline constexpr std::uint64_t kMaxReferenceSamples = std::uint64_t{1} << 32; // per pixel

bool reference_available(); // true if this program was built with Embree; own_rays need none

// Makes the renderer. Frame::stats.sampling holds the number of samples taken; Frame::variance is the mean's variance. The renderer
// ignores FrameDesc's technique, samples and tile size, and uses msaa for triangle ids only.
Result<std::unique_ptr<Renderer>> make_reference_renderer(const RenderInput& input, const ReferenceOptions& options);

// Returns the file of this picture's checkpoint; empty: none.
std::string checkpoint_of(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

// Checks before any work that the checkpoint can be resumed or does not exist.
Status check_reference_checkpoint(const RenderInput& input, const FrameDesc& desc, const ReferenceOptions& options);

} // namespace burnish
