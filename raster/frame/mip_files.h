// Inputs of mip filters besides maps: files of levels and nets. Warnings for maps that a filter leaves alone.
#pragma once
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish {

mipnet::Lobe lobe_of_model(int brdf); // returns the nets' lobe that is nearest to the model's

void warn_of_unfiltered(Scene& scene, const SceneMips& mips); // a line for each material that its filter makes nothing of, with the reason

// Gives materials their nets, of asked.net or the program's. Of filter mipnet, unless asked.fallback is off, those for which it is
// worse than it may be (mipnet::Comparison) get filter kappa or baseline in place of it, whichever is nearer to the reference. A
// warning says so.
// only: by material, which ones; null: all.
Status settle_nets(Scene& scene, SceneMips& mips, const MipSettings& asked, const Limits& limits, const std::vector<bool>* only = nullptr);

// Reads asked.pyramid. Where no filter was asked for, it is the file's. Refuses filter box, asked for by name, beside another filter's
// file.
Result<std::shared_ptr<const MipFile>> read_mips(MipSettings& asked, const Limits& limits);
// Materials take the filters that the levels of their maps are by, and colours what they are averaged and weighted by.
void take_filters_of_mips(const Scene& scene, SceneMips& mips);
// Checks that the file has all levels that the scene's filters would make, and levels of those materials' base colours, metalness and
// heights.
Status check_mips(const Scene& scene, SceneMips& mips, const std::string& path);

} // namespace burnish
