// The lobe of Ashikhmin and Shirley 2000: its half vectors, and its directional albedo without absorption, as f0 s + b.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace burnish {

inline constexpr double kMostPhongExponent = 1e6; // as shading has it

// To five digits, so that a number on a command line says a lobe's own exponent.
double rounded_exponent(double exponent);
double phong_exponent(double alpha); // 1 / alpha^2, rounded, at most kMostPhongExponent

struct PhongHalfVector {
    double x, y, z, density; // unit, in the lobe's frame; of half vectors, 1/sr
};
// xi: [0,1)^2; (0, 0) is the normal. With nu and nv exchanged, xi_x and 1/4 - xi_x give the same with x and y exchanged, bit for bit where
// that difference is exact.
PhongHalfVector phong_half_vector(double nu, double nv, double xi_x, double xi_y);

// Point i of n of one of four sets, which together are a lattice of 4 n points on the disc that azimuth and root of y span: rows of equal
// areas across the lobe's wide axis, a point each, which the golden ratio moves along its row. So lobes that are long have a sample at
// every 4 n-th of their length. Each fourth row is a set's. Both numbers are multiples of 1 / phong_grid(n). One point alone is (0, 0).
inline constexpr int kPhongSets = 4;
struct PhongPoint {
    double x, y;
};
PhongPoint phong_point(int i, int n, int set);
int phong_grid(int n); // texels a side of a table of half vectors that holds these points
// Half vectors at all points of these sets, one set after the other, in floats, as tables hold them.
std::vector<PhongHalfVector> phong_half_vectors(double nu, double nv, int samples);

struct PhongAlbedo {
    double s, b; // of light that Schlick's factor leaves to f0, and that it takes in any case
};

// v: to the eye, unit, v[2] above 0, in the lobe's frame; nu, nv: exponents along its first two axes. By a lattice of
// `points`, a number of Fibonacci (144 at least), of which `before` is the one before: the same bits everywhere.
PhongAlbedo phong_albedo(const double (&v)[3], double nu, double nv, int points = 987, int before = 610);

// What a table holds at an eye whose cosine is root_n_dot_v^2, at an azimuth whose cosine off the lobe's wide axis, that of the smaller
// exponent, is root_along^2.
PhongAlbedo phong_albedo_at(double nu, double nv, double root_n_dot_v, double root_along);

// The slice of a table that phong_slice_lookup() reads, of size x size / 2 pairs, with what `at` gives for both roots.
void fill_phong_slice(int size, const std::function<PhongAlbedo(double, double)>& at, float* pairs);

// How tables on files go through that azimuth: by root_along, as shading has it; or evenly, from the axis that nu is along to the other.
enum class AzimuthAxis { root, linear };

} // namespace burnish
