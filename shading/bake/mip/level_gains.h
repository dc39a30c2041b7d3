// One factor a level that its reflectances are multiplied by, so that it reflects as much light as level 0 does. What turns away from light
// or eye on level 0 reflects nothing; one lobe about a mean normal does not know of it, however wide it is.
#pragma once
#include <functional>
#include <vector>

#include "shading/bake/mip/shown.h"

namespace burnish {

inline constexpr float kLeastGain = 0.5f, kMostGain = 2.0f;

// Texels (x, y) of a level, 0: of level 0, as kChannels planes of `count` numbers, a multiple of kSlots.
using LevelTexels = std::function<void(int level, std::size_t count, const int* x, const int* y, float* planes)>;

struct LevelSize {
    int width, height;
};

// sizes: of level 0 and those after it; returned are the gains of those after it, in [kLeastGain, kMostGain]. Mean radiance under light of
// one radiance from 84 degrees around +z, seen from all sides, by 2048 or 4096 points of the map that are always the same: gain times what
// a level's reflectances f0 and diffuse give, with what grazing light gives whatever they are, is what level 0 gives. The bits depend
// neither on threads nor on the instruction set.
// rule: by which they will be lit.
std::vector<float> level_gains(const std::vector<LevelSize>& sizes, const LevelTexels& texels, const ShownSurface& surface, Gains rule);

// The same of a level 0 and the levels after it, as they are judged.
std::vector<float> level_gains(const std::vector<mipnet::Texels>& levels, const ShownSurface& surface);

// The same surface with reflectances times a gain. None of them passes 1 by it.
ShownSurface gained(const ShownSurface& surface, float gain);

} // namespace burnish
