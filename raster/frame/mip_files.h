// What mip filters need besides maps: levels of `burnish bake mip` that a scene brings along, nets, and what they leave alone.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/dress.h"
#include "core/scene/scene.h"
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish {

mipnet::Lobe lobe_of_model(int brdf); // of the nets there are, the nearest to a model's

void warn_of_unfiltered(Scene& scene); // a line for each material that its filter makes nothing of, with the reason

// Gives materials their nets, of with.mip_net or the program's. Of filter mipnet, unless with.mip_fallback is off, those for which it is
// worse than it may be (mipnet::Comparison) get filter kappa or baseline in place of it, whichever is nearer to the truth, and a warning
// says so.
Status settle_nets(Scene& scene, const Dress& with, const Limits& limits);

// Reads with.mip_pyramid to scene.mips. Where no filter was asked for, it is the file's.
Status read_mips(Scene& scene, Dress& with, const Limits& limits);
// Materials take the filters that the levels of their maps are by, and colours what they are averaged and weighted by.
void take_filters_of_mips(Scene& scene);
// Whether the file has levels of everything that filters of the scene would make levels of, and of these materials' base colours, metalness
// and heights.
Status check_mips(const Scene& scene, const std::string& path);

} // namespace burnish
