// What is fitted: the light that an anisotropic surface, of GGX or another model, reflects to one eye, as a density of directions, and the
// linearly transformed cosine that stands for it. Tangent frame: x and y the axes of the two widths, z the normal.
// Heitz, Dupuy, Hill, Neubelt 2016 (transformed cosines); Heitz 2014 (height-correlated Smith); Dupuy, Benyoub 2023 (visible normals).
#pragma once
#include <vector>

#include "shading/bake/ltc/matrix.h"

namespace burnish::ltc {

// Where a lobe lies in a table. theta, phi: of the eye, rad, off the normal and about it from x, in [0, pi/2]; alpha: the greater width,
// of x; lambda: the smaller one, of y, over it, in [0,1].
struct Place {
    double theta, phi, alpha, lambda;
};

// What lobes there are, as shading/models has them; files hold their order.
enum class Model { ggx, beckmann, ashikhmin_shirley, ward };
inline constexpr const char* kModelNames[] = {"ggx_aniso", "beckmann", "ashikhmin_shirley", "ward"};

// A lobe; widths are greater than 0 and the eye above the horizon.
struct Lobe {
    explicit Lobe(const Place& place, double albedo = 1.0, Model model = Model::ggx);
    Vec v; // to the eye
    double alpha_x, alpha_y;
    double shadow_v;       // Smith's Lambda of the eye on GGX
    double shadow_model_v; // on Beckmann
    double scale;          // 1 / (4 pi alpha_x alpha_y v.z)
    double albedo;         // what `reflected` integrates to, once it is known
    Model model;
};

struct Reflected {
    double visible;   // density of the mirrored visible normals of GGX, whose tails are the longest, which integrates to 1
    double reflected; // BRDF without Fresnel times the cosine, over the lobe's albedo
};
Reflected density(const Lobe& lobe, const Vec& l); // l: unit

// Points of the unit square, a Fibonacci lattice, as two mappings take them.
struct Rule {
    explicit Rule(int k); // the k-th Fibonacci number of points: 14: 377, 15: 610, 18: 2584, 22: 17711
    struct Point {
        double depth, cosine, sine; // of a cap: how far down, and the azimuth's
        Vec clamped;                // with the density z / pi
    };
    std::vector<Point> points;
};

Vec mirrored_normal(const Lobe& lobe, const Rule::Point& point); // a direction with the density of `visible`

struct Albedo {
    double all, grazing; // what returns of white light where Fresnel is 1, and where it is (1 - v.h)^5
};
Albedo albedo(const Lobe& lobe, const Rule& rule);
Lobe normalised_lobe(const Place& place, const Rule& rule, Model model = Model::ggx); // its albedo known

// Density at l of the transformed cosine whose matrix has the inverse n.
double transformed_cosine(const Matrix& n, const Vec& l);

// The first order of how slopes turn the mirror direction: near the fit for small widths, a start for others, and the gauge that
// neighbours share. Its third column is the mirror direction.
Matrix natural_matrix(const Place& place);

// M and M Rz(a) are one density, as are M and M with its second column negated. The one of them that is the nearest to the natural matrix,
// with a positive determinant.
Matrix in_natural_gauge(const Matrix& m, const Place& place);

} // namespace burnish::ltc
