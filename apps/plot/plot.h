// Figures of lobes: where a technique samples one, in three spaces.
#pragma once
#include "apps/report/drawing.h"

namespace burnish {

struct LobePlot {
    double roughness = 0.5, anisotropy = 0.8; // alpha_lin and eta: widths alpha_lin^2 (1 +- eta)
    double theta_deg = 50.0, phi_deg = 30.0;  // to the eye: from the normal, and about it from the grain
    double k = 1.0, beta = 2.3;
    int samples = 16;
};

// Density of slopes, of microfacet normals and of reflected directions, seen along the normal; the ellipse of k deviations, its extrema,
// the major axis and the samples on it with what each stands for. Cocco, Zanni, Chermain 2024, figures 2 and 6 to 12.
Drawing plot_axis(const LobePlot& lobe);

} // namespace burnish
