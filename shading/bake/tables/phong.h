// The lobe of Ashikhmin and Shirley 2000: its half vectors, and its directional albedo without absorption, as f0 s + b.
#pragma once

namespace burnish {

// 1 / alpha^2, at most 1e6, as shading has it.
double phong_exponent(double alpha);

struct PhongHalfVector {
    double x, y, z, density; // unit, in the lobe's frame; of half vectors, 1/sr
};
// xi: [0,1)^2; (0, 0) is the normal.
PhongHalfVector phong_half_vector(double nu, double nv, double xi_x, double xi_y);

struct PhongAlbedo {
    double s, b; // of light that Schlick's factor leaves to f0, and that it takes in any case
};

// v: to the eye, unit, v[2] above 0, in the lobe's frame; nu, nv: exponents along its first two axes, [0, 1e7]. By a lattice of
// `points`, a number of Fibonacci (144 at least), of which `before` is the one before: the same bits everywhere.
PhongAlbedo phong_albedo(const double (&v)[3], double nu, double nv, int points = 987, int before = 610);

} // namespace burnish
