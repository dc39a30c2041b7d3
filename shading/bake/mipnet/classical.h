// Mipmaps of normals and widths in closed form, in double: what nets are measured against, and what odd sizes are gathered with.
#pragma once
#include <vector>

#include "shading/bake/mipnet/texels.h"

namespace burnish::mipnet {

// baseline: normals averaged and made unit again, widths averaged. kappa: widths squared averaged in the frame of the mean normal, + kappa
// times the covariance of normals. ssgt: the SGGX matrices of Heitz, Dupuy, Crassin, Dachsbacher 2015 averaged; as a lobe, their mean slope
// and covariance. leadr: mean and covariance of slopes (Olano, Baker 2010; Dupuy et al. 2013), for Beckmann's lobe.
enum class Method { baseline, kappa, ssgt, leadr };

// A level of any size from one of any size: each texel takes what lies below it, by its area. Nothing crosses a border.
Texels shrunk(const Texels& from, int width, int height, Method method, double kappa);

// All levels, the first one `level0`, each side half of that before, rounded down, at least 1. ssgt and leadr come from level 0 itself.
std::vector<Texels> classical_pyramid(const Texels& level0, Method method, double kappa = 0.5);

int side_of_level(int side, int level);

} // namespace burnish::mipnet
