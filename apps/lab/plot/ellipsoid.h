// Measures the ellipsoid normal distribution's properties: Walter, Dong, Marschner, Greenberg 2014 (revised 2016), sections 2.2 to
// 5.1.
#pragma once
#include <string>
#include <vector>

#include "apps/lab/plot/ellipsoid_fns.h"

namespace burnish {

inline constexpr int kEllipsoidRows = 700, kEllipsoidColumns = 1400; // cells in integrals over normals, in cosine and azimuth
inline constexpr int kEllipsoidSamples = 200000;                     // normals drawn from each sampler

struct SamplerFigures {        // one visible-normal sampler's statistics
    double kept = 1.0;         // accepted points' share
    double kept_by_area = 1.0; // the acceptance rate predicted from projected areas
    double chi2 = 0.0;         // against the density, integrated over bins
    int freedom = 0;           // degrees of freedom: bins minus one
};

struct EllipsoidFigures {
    EllipsoidShape shape;
    PlotVec eye;
    double projected = 0.0;          // the integral over D times cosine: 1
    PlotVec mean{}, mean_by_shape{}; // mean normal, integrated and as A^T A n, unit
    double area_error = 0.0;         // largest difference over directions between the integrated and the closed-form visible area
    double clamped = 0.0;            // share of directions in which G1 exceeds 1 without the clamp
    double least_visible = 0.0;      // least visible area over macrosurface area, over directions; below 1 the microsurface is incomplete
    double wall = 0.0;               // area of a vertical wall that turns the mean normal to the surface normal, over the surface area
    double least_with_wall = 0.0;    // least_visible with the wall
    SamplerFigures samplers[3];      // by rejection from a sphere, from the ellipsoid's outline, and without rejection (versions 1 to 3)
};

std::vector<EllipsoidFigures> measure_ellipsoids(); // for a few settings, upright and tilted

struct EnergyRow {
    double theta_deg;        // the light's angle, towards the tilt
    double skew, normal_map; // share reflected by a surface without absorption
};
// Measures the energy from a lobe tilted by 25 degrees, and from an upright lobe under a normal map with the same peak.
std::vector<EnergyRow> measure_skew();

std::string ellipsoid_page(); // HTML

} // namespace burnish
