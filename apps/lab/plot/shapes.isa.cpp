#include "apps/lab/plot/shapes.h"

#include "apps/lab/plot/plot_vec.h"
#include "shading/lang/tables.h"
#include "shading/surface/lobe.k.h"
#include "shading/techniques/bent_normal.k.h"
#include "shading/techniques/major_axis.k.h"
#define BN_LOBE_TEXTS
#include "shading/models.def"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

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

struct Placed { // lobe parameters made by lines of models.def (shading/surface/bsdf_lobe.t.h)
    double alpha_u, alpha_v;
    real3 u, v, n;
};

Placed placed(const LobeInPlace& l)
{
    const ellipsoid_params axes = ellipsoid_params_of(l.alpha_x, l.alpha_y, l.tilt_x, l.tilt_y, 0.0);
    Placed a = {l.alpha_x, l.alpha_y, axes.r0, axes.r1, axes.r2};
    if (lobe_traits_of(l.model) & kLies_round)
        a.alpha_u = a.alpha_v = 0.5 * (l.alpha_x + l.alpha_y);
    return a;
}

// Converts to the model's axes: a thread has its x across the grain.
real3 along(const LobeInPlace& l, const PlotVec& w)
{
    return lobe_traits_of(l.model) & kLies_thread ? vec3_of(w.y, w.x, w.z) : of(w);
}

double value(const LobeInPlace& l, const PlotVec& to_eye, const PlotVec& to_light)
{
    const Placed a = placed(l);
    const real3 o = along(l, to_eye), i = along(l, to_light);
    const double cosine = lobe_traits_of(l.model) & kLies_thread ? 1.0 : max(i.z, 0.0);
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (l.model == at)                                                                                                                     \
        return id##_eval(made_of, o, i) * cosine;
#include "shading/models.def"
    return 0.0;
}

double visible(const LobeInPlace& l, const PlotVec& to_eye, const PlotVec& half)
{
    const Placed a = placed(l);
    const real3 o = along(l, to_eye), h = along(l, half);
#define BN_HALF_round(id, p) id##_half_pdf(p, o, h)
#define BN_HALF_level(id, p) id##_half_pdf(p, o, h)
#define BN_HALF_surface(id, p) id##_half_pdf(p, o, h)
#define BN_HALF_thread(id, p) 0.0
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (l.model == at)                                                                                                                     \
        return BN_HALF_##lies(id, made_of);
#include "shading/models.def"
    return 0.0;
}

PlotVec mean_direction(const LobeInPlace& l, const PlotVec& to_eye, int n)
{
    const ggx_aniso_params p = ggx_aniso_params_of(l.alpha_x, l.alpha_y);
    real3 sum = vec3_of(0.0, 0.0, 0.0);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const bsdf_sample b = ggx_aniso_sample(p, of(to_eye), vec2_of((i + 0.5) / n, (k + 0.5) / n));
            sum = sum + b.wi * b.weight;
        }
    return to(sum);
}

PlotVec bent_direction(const LobeInPlace& l, const PlotVec& to_eye)
{
    const double root = 0.70710678118654752;
    const aniso_lobe lobe = {vec3_of(1.0, 0.0, 0.0), vec3_of(0.0, 1.0, 0.0), l.alpha_x * root, l.alpha_y * root};
    return to(k_normalize3(bent_normal_ray(vec3_of(0.0, 0.0, 1.0), of(to_eye), lobe).direction));
}

PlotVec peak_normal(const LobeInPlace& l)
{
    return to(placed(l).n);
}

constexpr PlotFns kFns = {axis, normal_at, mirrored, normals, lobe, value, visible, mean_direction, bent_direction, peak_normal};

} // namespace

BN_DEFINE_FNS(PlotFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
