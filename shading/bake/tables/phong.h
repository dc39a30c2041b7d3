// The Ashikhmin-Shirley lobe (2000): its half vectors, and its directional albedo without absorption, as f0 s + b.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace burnish {

inline constexpr double kMostPhongExponent = 1e6; // as in shading

// Rounds to five digits, so that a command line can state a lobe's exact exponent.
double rounded_exponent(double exponent);
double phong_exponent(double alpha); // 1 / alpha^2, rounded, at most kMostPhongExponent

struct PhongHalfVector {
    double x, y, z, density; // unit, in the lobe's frame; density of half vectors, 1/sr
};
// Returns a half vector. xi: [0,1)^2; (0, 0) gives the normal. Exchanged nu and nv, with 1/4 - xi_x for xi_x, give exchanged x and y: bit
// for bit if the difference is exact.
PhongHalfVector phong_half_vector(double nu, double nv, double xi_x, double xi_y);

// Returns point i of n in one of four sets. Together the sets form a lattice with 4 n points on the disc that azimuth and root of y span.
// The lattice has rows with equal areas across the lobe's wide axis, one point each. The golden ratio moves the point along its row. So a
// long lobe has a sample at every 4 n-th part along its length. Each set owns every fourth row. Both coordinates are multiples of 1 /
// phong_grid(n). A single point is (0, 0).
inline constexpr int kPhongSets = 4;
struct PhongPoint {
    double x, y;
};
PhongPoint phong_point(int i, int n, int set);
int phong_grid(int n); // side of a half vector table that holds these points, texels
// Returns the half vectors at all points in all sets, one set after the other, rounded to floats as in tables.
std::vector<PhongHalfVector> phong_half_vectors(double nu, double nv, int samples);

struct PhongAlbedo {
    double s, b; // share that Schlick's factor leaves to f0; share that it reflects in any case
};

// Integrates the albedo. v: to the eye, unit, v[2] above 0, in the lobe's frame. nu, nv: exponents along its first two axes. points:
// lattice size, a Fibonacci number (144 at least); before: the Fibonacci number before it. The bits are equal everywhere.
PhongAlbedo phong_albedo(const double (&v)[3], double nu, double nv, int points = 987, int before = 610);

// Returns a table entry. The eye's cosine is root_n_dot_v^2. The cosine of the eye's azimuth from the lobe's wide axis, with the smaller
// exponent, is root_along^2.
PhongAlbedo phong_albedo_at(double nu, double nv, double root_n_dot_v, double root_along);

// Fills a slice for phong_slice_lookup() with size x size / 2 pairs. at: the albedo for both roots.
void fill_phong_slice(int size, const std::function<PhongAlbedo(double, double)>& at, float* pairs);

// Spacing of azimuths in table files: by root_along, as in shading; or even, from the axis with exponent nu to the other axis.
enum class AzimuthAxis { root, linear };

} // namespace burnish
