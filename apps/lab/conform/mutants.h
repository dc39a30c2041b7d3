// Mistakes that engines make, each drawn by burnish's own kernels with one thing wrong.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class MutantSky : std::uint8_t { right, mirrored_x, mirrored_y, mirrored_z, turned_quarter, turned_half, turned_back };

struct Mutant {
    const char* name;                         // in reports
    const char* words;                        // the mistake, a sentence without its full stop
    std::uint32_t kernels = 0;                // bits of KernelMutant
    bool (*scene)(Scene& scene) = nullptr;    // edits the scene; false: it has nothing to edit
    MutantSky sky = MutantSky::right;         // of scenes under the environment
    void (*frame)(FrameDesc& desc) = nullptr; // edits the frame's settings
    void (*picture)(Image& linear) = nullptr; // edits the finished picture, f32 RGB
};
const std::vector<Mutant>& mutants();

// Returns the picture as another sky shows it: mirrored or turned. environment: equirectangular, f32 RGB.
Image changed_sky(const Image& environment, MutantSky sky);

} // namespace burnish
