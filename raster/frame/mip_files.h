// Inputs of mip filters besides maps: levels from `burnish bake mip` and nets. Warnings for maps that a filter leaves alone.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/dress.h"
#include "core/scene/scene.h"
#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish {

mipnet::Lobe lobe_of_model(int brdf); // returns the nets' lobe that is nearest to the model's

void warn_of_unfiltered(Scene& scene); // adds a warning with the reason for each material that its filter cannot handle

// Gives materials the net at with.mip_net, or the built-in net. Compares filter mipnet with others on each material, unless
// with.mip_fallback is off. Where the net's error is too large (mipnet::Comparison), the material gets filter kappa or baseline, whichever
// has the smaller error, and the scene a warning.
Status settle_nets(Scene& scene, const Dress& with, const Limits& limits);

// Reads with.mip_pyramid into scene.mips. If no filter was chosen, takes the file's filter.
Status read_mips(Scene& scene, Dress& with, const Limits& limits);
// Sets each material's filter, colour kernel and colour coupling to those of the file's levels for its maps.
void take_filters_of_mips(Scene& scene);
// Checks that the file has levels for all maps that the scene's filters handle, and for these materials' base colours, metalness and
// heights.
Status check_mips(const Scene& scene, const std::string& path);

} // namespace burnish
