// The ellipsoid normal distribution and its references, evaluated by the kernels in double precision.
#pragma once
#include "apps/lab/plot/shapes.h"

namespace burnish {

struct EllipsoidShape {
    double alpha_x, alpha_y;          // GGX widths
    double theta_x, theta_y, theta_z; // rad, as arguments of ellipsoid_params_of
};

struct NormalSample {
    PlotVec m, wi; // normal, and the eye direction mirrored about it
    double weight; // for wi; 0 for an invalid sample
};

struct EllipsoidFns {
    double (*d)(const EllipsoidShape& s, const PlotVec& m);
    double (*half_pdf)(const EllipsoidShape& s, const PlotVec& o, const PlotVec& m);
    double (*visible_area)(const EllipsoidShape& s, const PlotVec& u); // area of the normals visible from u, over the surface area
    double (*g1)(const EllipsoidShape& s, const PlotVec& u);
    PlotVec (*map)(const EllipsoidShape& s, const PlotVec& u);        // A u
    PlotVec (*transposed)(const EllipsoidShape& s, const PlotVec& v); // A^T v
    PlotVec (*peak)(const EllipsoidShape& s);                         // the most frequent normal
    NormalSample (*sample)(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y);
    // Samples an upright GGX lobe with these widths; o is in the lobe's own frame.
    NormalSample (*upright)(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y);
};
BN_DECLARE_FNS(EllipsoidFns);

} // namespace burnish
