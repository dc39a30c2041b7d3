// Lobes' figures: their shapes, and the samples a technique takes.
#pragma once
#include "apps/report/drawing.h"

namespace burnish {
namespace ltc {
struct Table;
}

struct LobePlot {
    double roughness = 0.5, anisotropy = 0.8; // roughness and eta: widths roughness^2 (1 +- eta)
    double theta_deg = 50.0, phi_deg = 30.0;  // direction to the eye: from the normal, and about it from the grain
    double k = 1.0, beta = 2.3;
    int samples = 16;
    int model = 0;                             // the lobe's index in shading/models.def
    double rotation_deg = 45.0;                // the grain, from the parallels in plot_side()
    double tilt_x_deg = 0.0, tilt_y_deg = 0.0; // for lobes that can tilt: towards the bitangent, away from the tangent
};

// Draws the densities for slopes, microfacet normals and reflected directions, seen along the normal. Over each: the ellipse at k
// deviations, its extrema, the major axis, and the samples on it with their extents. Cocco, Zanni, Chermain 2024, figures 2 and 6 to 12.
Drawing plot_axis(const LobePlot& lobe);

// Draws any model's lobe, BRDF times cosine without Fresnel: visible half vectors, reflected directions with contours, and cuts
// through the peak, along the normal and across it.
Drawing plot_lobe(const LobePlot& lobe);

// Draws the half vectors sampled from an Ashikhmin-Shirley lobe, from above and as a table over both random numbers, and the
// directional albedo's table. Exponents are 1 / alpha^2. Ashikhmin and Shirley 2000.
Drawing plot_half_vectors(const LobePlot& lobe);

// Draws the energy lost by a white dielectric with this lobe and its diffuse term: over both exponents, from four view angles.
Drawing plot_energy();

// Draws techniques' fetch direction over a sphere, up or down, and marks points on the wrong side of the lobe's mean. Also draws
// such points' share over anisotropy. Cocco, Zanni, Chermain 2024, figure 20.
Drawing plot_side(const LobePlot& lobe);

// Draws a GGX lobe and its transformed cosines: from the table, the nearest cosine, and the nearest sum of two. Draws fits from three
// starts in three norms. Draws two matrices' averages, for one lobe and for two, rotated and aligned. Draws where a matrix moves a
// cosine's points. KT, Heitz, Dupuy, Narayanan 2022, figures 4, 7, 8 and 13.
Drawing plot_ltc(const LobePlot& lobe, const ltc::Table& table, bool quiet); // quiet: without progress

} // namespace burnish
