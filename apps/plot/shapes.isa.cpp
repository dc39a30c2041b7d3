#include "apps/plot/shapes.h"

#include "shading/models/ggx_aniso.k.h"
#include "shading/techniques/major_axis.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

real3 of(const PlotVec& v)
{
    return vec3_of(v.x, v.y, v.z);
}

PlotVec to(real3 v)
{
    return {v.x, v.y, v.z};
}

void axis(double alpha_x, double alpha_y, const PlotVec& o, double k, double beta, int samples, AxisShape& shape)
{
    const double sigma_x = alpha_x / 1.4142135623730951, sigma_y = alpha_y / 1.4142135623730951;
    const major_axis_line line = major_axis_setup(of(o), sigma_x, sigma_y, k, beta, 1.0 / samples);
    const major_axis_ends ends = major_axis_extrema(of(o), k * sigma_x, k * sigma_y);
    shape = {ends.t_near, ends.t_far, {to(line.e0), to(line.e1)}, line.radius};
}

PlotVec normal_at(double t, double rx, double ry)
{
    return to(ellipse_normal(k_cos(t), k_sin(t), rx, ry));
}

PlotVec mirrored(const PlotVec& w, const PlotVec& o)
{
    return to(reflect_about(of(w), of(o)));
}

double normals(double alpha_x, double alpha_y, const PlotVec& w)
{
    return ggx_aniso_d(ggx_aniso_params_of(alpha_x, alpha_y), of(w));
}

double lobe(double alpha_x, double alpha_y, const PlotVec& o, const PlotVec& i)
{
    return ggx_aniso_eval(ggx_aniso_params_of(alpha_x, alpha_y), of(o), of(i)) * i.z;
}

constexpr PlotFns kFns = {axis, normal_at, mirrored, normals, lobe};

} // namespace

BN_DEFINE_FNS(PlotFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
