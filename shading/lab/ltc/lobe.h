// Input and model of a fit: the light that an anisotropic surface (GGX or another model) reflects to one eye, as a density over
// directions, and the linearly transformed cosine that approximates it. Tangent frame: x and y are the axes of the two widths, z the
// normal. Heitz, Dupuy, Hill, Neubelt 2016 (transformed cosines); Heitz 2014 (height-correlated Smith); Dupuy, Benyoub 2023 (visible
// normals).
#pragma once
#include <vector>

#include "shading/bake/ltc/place.h"

namespace burnish::ltc {

// A lobe. Widths are greater than 0 and the eye is above the horizon.
struct Lobe {
    explicit Lobe(const Place& place, double albedo = 1.0, Model model = Model::ggx);
    Vec v; // to the eye
    double alpha_x, alpha_y;
    double shadow_v;       // Smith's Lambda for the eye on GGX
    double shadow_model_v; // on Beckmann
    double scale;          // 1 / (4 pi alpha_x alpha_y v.z)
    double albedo;         // integral of `reflected`, once known
    Model model;
};

struct Reflected {
    double visible;   // density of mirrored visible GGX normals, which have the longest tails; integrates to 1
    double reflected; // BRDF without Fresnel times the cosine, over the lobe's albedo
};
Reflected density(const Lobe& lobe, const Vec& l); // l: unit

// Points in the unit square, a Fibonacci lattice, prepared for two mappings.
struct Rule {
    explicit Rule(int k); // the k-th Fibonacci number of points: 14: 377, 15: 610, 18: 2584, 22: 17711
    struct Point {
        double depth, cosine, sine; // on a cap: depth, and the azimuth's cosine and sine
        Vec clamped;                // with density z / pi
    };
    std::vector<Point> points;
};

Vec mirrored_normal(const Lobe& lobe, const Rule::Point& point); // a direction with the density `visible`

Albedo albedo(const Lobe& lobe, const Rule& rule);
Lobe normalised_lobe(const Place& place, const Rule& rule, Model model = Model::ggx); // with its albedo known

// Returns the transformed cosine's density at l. n: the matrix' inverse.
double transformed_cosine(const Matrix& n, const Vec& l);

// Removes the ambiguity of a matrix: M and M Rz(a) are one density, as are M and M with its second column negated. Returns the equivalent
// that is nearest to the natural matrix, with a positive determinant.
Matrix in_natural_gauge(const Matrix& m, const Place& place);

} // namespace burnish::ltc
