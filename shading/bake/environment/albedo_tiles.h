// The albedo of lobes with two widths as one texture, for engines.
#pragma once
#include <vector>

namespace burnish {

// Texels along each side.
inline constexpr int kAlbedoTilesSide = 200;

// Returns the pairs of lobe_albedo_pairs() in rows of kAlbedoTilesSide texels. Tiles of kLobeAlbedoSize x kLobeAlbedoSize texels: n.v to
// the right and roughness downwards. Tiles to the right: azimuths of the view; tiles downwards: anisotropy. Axes: lobe_albedo_place_of() in
// shading/surface/energy.k.h.
std::vector<float> albedo_tiles();

} // namespace burnish
