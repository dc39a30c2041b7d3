#include "apps/lab/plot/ellipsoid_fns.h"

#include "apps/lab/plot/plot_vec.h"
#include "shading/models/ellipsoid.k.h"
#include "shading/models/ggx_aniso.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

ellipsoid_params of(const EllipsoidShape& s)
{
    return ellipsoid_params_of(s.alpha_x, s.alpha_y, s.theta_x, s.theta_y, s.theta_z);
}

double d(const EllipsoidShape& s, const PlotVec& m)
{
    return ellipsoid_d(of(s), of(m));
}

double half_pdf(const EllipsoidShape& s, const PlotVec& o, const PlotVec& m)
{
    return ellipsoid_half_pdf(of(s), of(o), of(m));
}

double visible_area(const EllipsoidShape& s, const PlotVec& u)
{
    return 1.0 / ellipsoid_seen_from(of(s), of(u)).k;
}

double g1(const EllipsoidShape& s, const PlotVec& u)
{
    return ellipsoid_g1(of(s), of(u));
}

PlotVec map(const EllipsoidShape& s, const PlotVec& u)
{
    return to(ellipsoid_map(of(s), of(u)));
}

PlotVec transposed(const EllipsoidShape& s, const PlotVec& v)
{
    const ellipsoid_params p = of(s);
    return to(p.r0 * (p.alpha_x * v.x) + p.r1 * (p.alpha_y * v.y) + p.r2 * v.z);
}

PlotVec peak(const EllipsoidShape& s)
{
    return to(of(s).r2);
}

NormalSample sample_of(const bsdf_sample& b, real3 m)
{
    return {to(m), to(b.wi), b.weight};
}

NormalSample sample(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y)
{
    const ellipsoid_params p = of(s);
    const real2 xi = vec2_of(xi_x, xi_y);
    return sample_of(ellipsoid_sample(p, of(o), xi), ellipsoid_visible_normal(p, ellipsoid_seen_from(p, of(o)), of(o), xi));
}

NormalSample upright(const EllipsoidShape& s, const PlotVec& o, double xi_x, double xi_y)
{
    const ggx_aniso_params p = ggx_aniso_params_of(s.alpha_x, s.alpha_y);
    const real2 xi = vec2_of(xi_x, xi_y);
    return sample_of(ggx_aniso_sample(p, of(o), xi), ggx_aniso_visible_normal(p, of(o), xi));
}

constexpr EllipsoidFns kFns = {d, half_pdf, visible_area, g1, map, transposed, peak, sample, upright};

} // namespace

BN_DEFINE_FNS(EllipsoidFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
