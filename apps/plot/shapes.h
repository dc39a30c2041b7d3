// The lobe's geometry that `burnish plot` draws, by the kernels themselves in double precision.
#pragma once
#include "core/simd/fns.h"

namespace burnish {

struct PlotVec {
    double x, y, z;
};

struct AxisShape {        // in the ellipse frame: x along the greater deviation of slope, y along the smaller, z the normal
    double t_near, t_far; // parameters of the ellipse of slopes: closest to the mirror direction, and farthest from it
    PlotVec ends[2];      // microfacet normals between which samples lie
    double radius;        // that a sample stands for, as a distance of directions
};

struct PlotFns {
    // alpha_x, alpha_y: widths of the GGX lobe; k: deviations of slope that the axis covers; beta: overlap; o: to the eye, unit.
    void (*axis)(double alpha_x, double alpha_y, const PlotVec& o, double k, double beta, int samples, AxisShape& shape);
    PlotVec (*normal_at)(double t, double rx, double ry);                               // of the ellipse with those radii of slopes
    PlotVec (*mirrored)(const PlotVec& w, const PlotVec& o);                            // o about w
    double (*normals)(double alpha_x, double alpha_y, const PlotVec& w);                // density of microfacet normals D(w)
    double (*lobe)(double alpha_x, double alpha_y, const PlotVec& o, const PlotVec& i); // BRDF without Fresnel, times the cosine of i
};
BN_DECLARE_FNS(PlotFns);

} // namespace burnish
