// The ellipsoid distribution of normals and what it is compared with, by the kernels in double precision.
#pragma once
#include "apps/plot/shapes.h"

namespace burnish {

struct EllipsoidShape {
    double alpha_x, alpha_y;          // widths
    double theta_x, theta_y, theta_z; // rad, as ellipsoid_params_of takes them
};

struct NormalSample {
    PlotVec m, wi; // normal, and the eye mirrored about it
    double weight; // of wi; 0 where it is none
};

struct EllipsoidFns {
    double (*d)(const EllipsoidShape& s, const PlotVec& m);
    double (*half_pdf)(const EllipsoidShape& s, const PlotVec& o, const PlotVec& m);
    double (*visible_area)(const EllipsoidShape& s, const PlotVec& u); // of normals that u sees, over the surface's own area
    double (*g1)(const EllipsoidShape& s, const PlotVec& u);
    PlotVec (*map)(const EllipsoidShape& s, const PlotVec& u);        // A u
    PlotVec (*transposed)(const EllipsoidShape& s, const PlotVec& v); // A^T v
    PlotVec (*peak)(const EllipsoidShape& s);                         // the commonest normal
    NormalSample (*sample)(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y);
    // Of an upright GGX lobe of those widths, o in its own frame.
    NormalSample (*upright)(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y);
};
BN_DECLARE_FNS(EllipsoidFns);

} // namespace burnish
