// Lobes by their position in a table of transformed cosines. Tangent frame: x and y are the axes of the two widths, z the normal.
#pragma once
#include "shading/bake/ltc/matrix.h"

namespace burnish::ltc {

// A lobe's position in a table. theta, phi: of the eye, rad, from the normal and about it from x, in [0, pi/2]. alpha: the greater width,
// along x. lambda: the smaller width, along y, over alpha, in [0,1].
struct Place {
    double theta, phi, alpha, lambda;
};

// Lobe models, as in shading/models. Files store their numbers.
enum class Model { ggx, beckmann, ashikhmin_shirley, ward };
inline constexpr const char* kModelNames[] = {"ggx_aniso", "beckmann", "ashikhmin_shirley", "ward"};

struct Albedo {
    double all, grazing; // reflected share of white light with Fresnel 1, and with Fresnel (1 - v.h)^5
};

Vec eye_of(const Place& place); // unit

// Returns the first-order map from slopes to the mirrored direction. It is near the fit for small widths, a start for others, and the
// gauge that neighbours share. Its third column is the mirror direction.
Matrix natural_matrix(const Place& place);

} // namespace burnish::ltc
