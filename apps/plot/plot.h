// Figures of lobes: what they look like, and where a technique samples one.
#pragma once
#include "apps/report/drawing.h"

namespace burnish {
namespace ltc {
struct Table;
}

struct LobePlot {
    double roughness = 0.5, anisotropy = 0.8; // alpha_lin and eta: widths alpha_lin^2 (1 +- eta)
    double theta_deg = 50.0, phi_deg = 30.0;  // to the eye: from the normal, and about it from the grain
    double k = 1.0, beta = 2.3;
    int samples = 16;
    int model = 0;                             // of the lobe, its place in shading/models.def
    double rotation_deg = 45.0;                // of the grain, from the parallels of plot_side()
    double tilt_x_deg = 0.0, tilt_y_deg = 0.0; // of one that can be tilted: towards the bitangent and away from the tangent
};

// Density of slopes, of microfacet normals and of reflected directions, seen along the normal; the ellipse of k deviations, its extrema,
// the major axis and the samples on it with what each stands for. Cocco, Zanni, Chermain 2024, figures 2 and 6 to 12.
Drawing plot_axis(const LobePlot& lobe);

// A lobe of any model, BRDF times cosine without Fresnel: the half vectors that the eye sees, the reflected directions with contours, and
// cuts through its peak, along the normal and across.
Drawing plot_lobe(const LobePlot& lobe);

// Half vectors that a lobe of Ashikhmin and Shirley samples, seen from above and as a table over both random numbers, and the table of its
// directional albedo: exponents 1 / alpha^2. Ashikhmin and Shirley 2000.
Drawing plot_half_vectors(const LobePlot& lobe);

// What a white dielectric of that lobe, with its own diffuse part, loses: over both exponents, seen from four angles.
Drawing plot_energy();

// Which way techniques look from the points of a sphere, up or down, where that is not the way of the lobe's mean, and the share of such
// points by anisotropy; the same, figure 20.
Drawing plot_side(const LobePlot& lobe);

// A GGX lobe and the transformed cosines that stand for it: of the table, the nearest one, the nearest sum of two; fits of one from three
// starts by three norms; what lies between two matrices of one lobe and of two, turned apart and aligned; and where a matrix takes the
// points of a cosine. KT, Heitz, Dupuy, Narasimhan 2022, figures 4, 7, 8 and 13.
Drawing plot_ltc(const LobePlot& lobe, const ltc::Table& table);

} // namespace burnish
