// Levels of `burnish bake mip` that a scene brings along, and what mip filters leave alone.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/dress.h"
#include "core/scene/scene.h"

namespace burnish {

void warn_of_unfiltered(Scene& scene); // a line for each material that its filter makes nothing of, with the reason

// Reads with.mip_pyramid to scene.mips. Where no filter was asked for, it is the file's.
Status read_mips(Scene& scene, Dress& with, const Limits& limits);
// Whether the file has levels of everything that filters of the scene would make levels of.
Status check_mips(const Scene& scene, const std::string& path);

} // namespace burnish
