// What the ellipsoid distribution of normals promises, measured: Walter, Dong, Marschner, Greenberg 2014 (revised 2016), sections 2.2
// to 5.1.
#pragma once
#include <string>
#include <vector>

#include "apps/plot/ellipsoid_fns.h"

namespace burnish {

inline constexpr int kEllipsoidRows = 700, kEllipsoidColumns = 1400; // of the integrals over normals, in cosine and azimuth
inline constexpr int kEllipsoidSamples = 200000;                     // normals that each sampler is measured by

struct SamplerFigures {        // of one way to draw normals that an eye sees
    double kept = 1.0;         // share of the points that are tried and not rejected
    double kept_by_area = 1.0; // the same by projected areas
    double chi2 = 0.0;         // against the density, integrated over bins
    int freedom = 0;           // bins less one
};

struct EllipsoidFigures {
    EllipsoidShape shape;
    PlotVec eye;
    double projected = 0.0;          // integral of D times cosine: 1
    PlotVec mean{}, mean_by_shape{}; // of normals, by integration and A^T A n, unit
    double area_error = 0.0;         // largest difference of the visible area, by integration and in closed form, over directions
    double clamped = 0.0;            // share of directions for which G1 would be above 1
    double least_visible = 0.0;      // least visible area over the surface's own, over directions: below 1 the surface lacks some
    double wall = 0.0;               // vertical area that makes the mean normal the surface's, over the surface's own area
    double least_with_wall = 0.0;    // least_visible then
    SamplerFigures samplers[3];      // by rejection from a sphere, from the ellipsoid's outline, and without (versions 1 to 3)
};

std::vector<EllipsoidFigures> measure_ellipsoids(); // of a few settings, upright and tilted

struct EnergyRow {
    double theta_deg;        // of the light, towards the tilt
    double skew, normal_map; // share that a surface that absorbs nothing gives back
};
// Of a lobe tilted by 25 degrees, and of the upright one with a normal map that has the same peak.
std::vector<EnergyRow> measure_skew();

std::string ellipsoid_page(); // HTML

} // namespace burnish
