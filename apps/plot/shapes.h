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

// A lobe as it lies on a surface: frame t, b, n with the grain along t.
struct LobeInPlace {
    int model = 0;                         // its place among the lobes of shading/models.def
    double alpha_x = 0.25, alpha_y = 0.25; // GGX widths along and across the grain
    double tilt_x = 0.0, tilt_y = 0.0;     // rad; of one that can be tilted
};

struct PlotFns {
    // alpha_x, alpha_y: widths of the GGX lobe; k: deviations of slope that the axis covers; beta: overlap; o: to the eye, unit.
    void (*axis)(double alpha_x, double alpha_y, const PlotVec& o, double k, double beta, int samples, AxisShape& shape);
    PlotVec (*normal_at)(double t, double rx, double ry);                               // of the ellipse with those radii of slopes
    PlotVec (*mirrored)(const PlotVec& w, const PlotVec& o);                            // o about w
    double (*normals)(double alpha_x, double alpha_y, const PlotVec& w);                // density of microfacet normals D(w)
    double (*lobe)(double alpha_x, double alpha_y, const PlotVec& o, const PlotVec& i); // BRDF without Fresnel, times the cosine of i
    double (*value)(const LobeInPlace& lobe, const PlotVec& o, const PlotVec& i);       // the same of any model
    double (*visible)(const LobeInPlace& lobe, const PlotVec& o, const PlotVec& h);     // density of the half vectors that o sees; 0: none
    // Mean of the directions that the lobe reflects o to, by n x n of the samples of a GGX lobe whose alpha_x is not below alpha_y.
    PlotVec (*mean_direction)(const LobeInPlace& lobe, const PlotVec& o, int n);
    PlotVec (*bent_direction)(const LobeInPlace& lobe, const PlotVec& o); // that bent_normal fetches, for such a lobe
    PlotVec (*peak_normal)(const LobeInPlace& lobe);                      // the commonest microfacet normal
};
BN_DECLARE_FNS(PlotFns);

} // namespace burnish
