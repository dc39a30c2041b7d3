// Lobe geometry for `burnish plot`, evaluated by the kernels in double precision.
#pragma once
#include "core/simd/fns.h"

namespace burnish {

struct PlotVec {
    double x, y, z;
};

struct AxisShape {        // in the ellipse frame: x along the larger slope deviation, y along the smaller, z the normal
    double t_near, t_far; // parameters on the slope ellipse: closest to the mirror direction, farthest from it
    PlotVec ends[2];      // microfacet normals at the ends of the sample line
    double radius;        // one sample's extent, as a distance between directions
};

// A lobe on a surface: frame t, b, n with the grain along t.
struct LobeInPlace {
    int model = 0;                         // index among the lobes of shading/models.def
    double alpha_x = 0.25, alpha_y = 0.25; // GGX widths along and across the grain
    double tilt_x = 0.0, tilt_y = 0.0;     // rad; for lobes that can tilt
};

struct PlotFns {
    // alpha_x, alpha_y: GGX widths; k: slope deviations covered by the axis; beta: overlap of samples; o: direction to the eye, unit.
    void (*axis)(double alpha_x, double alpha_y, const PlotVec& o, double k, double beta, int samples, AxisShape& shape);
    PlotVec (*normal_at)(double t, double rx, double ry);                               // normal on the ellipse with these slope radii
    PlotVec (*mirrored)(const PlotVec& w, const PlotVec& o);                            // mirrors o about w
    double (*normals)(double alpha_x, double alpha_y, const PlotVec& w);                // density of microfacet normals D(w)
    double (*lobe)(double alpha_x, double alpha_y, const PlotVec& o, const PlotVec& i); // BRDF without Fresnel, times the cosine of i
    double (*value)(const LobeInPlace& lobe, const PlotVec& o, const PlotVec& i);       // lobe() for any model
    double (*visible)(const LobeInPlace& lobe, const PlotVec& o, const PlotVec& h);     // density of half vectors visible from o; 0: none
    // Returns the mean reflected direction for o, over n x n samples of a GGX lobe with alpha_x >= alpha_y.
    PlotVec (*mean_direction)(const LobeInPlace& lobe, const PlotVec& o, int n);
    PlotVec (*bent_direction)(const LobeInPlace& lobe, const PlotVec& o); // fetch direction of bent_normal, for such a lobe
    PlotVec (*peak_normal)(const LobeInPlace& lobe);                      // the most frequent microfacet normal
};
BN_DECLARE_FNS(PlotFns);

} // namespace burnish
