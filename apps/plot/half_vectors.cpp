#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/plot/panel.h"
#include "apps/plot/plot.h"
#include "shading/bake/tables/phong.h"

namespace burnish {
namespace {

constexpr int kSampleSide = 16, kCells = 50; // samples and cells along each side

// A square of colours over [0,1]^2, x to the right and y up.
template <class Colour> void draw_table(Drawing& out, const char* title, double left, const Colour& colour)
{
    const double cell = kSide / kCells;
    out.text(left + 0.5 * kSide, kTop - 14.0, "title middle", title);
    for (int y = 0; y < kCells; ++y)
        for (int x = 0; x < kCells; ++x)
            out.rectangle(left + cell * x, kTop + cell * (kCells - 1 - y), cell + 0.3, cell + 0.3, "",
                          colour((x + 0.5) / kCells, (y + 0.5) / kCells));
}

Paint paint_of(double r, double g, double b)
{
    const auto code = [](double unit) { return 255.0 * std::clamp(unit, 0.0, 1.0); };
    return {code(r), code(g), code(b)};
}

} // namespace

Drawing plot_half_vectors(const LobePlot& lobe)
{
    const double a = lobe.roughness * lobe.roughness;
    const double nu = phong_exponent(a * (1.0 + lobe.anisotropy)), nv = phong_exponent(a * (1.0 - lobe.anisotropy));
    Drawing out(3.0 * kSide + 4.0 * kGap, kTop + kSide + kBelow, "chart",
                fmt::format("Half vectors of an Ashikhmin-Shirley lobe, {:g} and {:g}", nu, nv));
    const Panel above{"half vectors", kGap, 1.0};
    draw_density(out, above, Edge::horizon, [&](const Place& p) {
        const double r2 = p.x * p.x + p.y * p.y, z = std::sqrt(std::max(1.0 - r2, 0.0));
        return r2 < 1.0 ? std::pow(z, (nu * p.x * p.x + nv * p.y * p.y) / std::max(r2, 1e-12)) : 0.0;
    });
    draw_frame(out, above, Edge::horizon);
    for (int y = 0; y < kSampleSide; ++y)
        for (int x = 0; x < kSampleSide; ++x) {
            const PhongHalfVector h = phong_half_vector(nu, nv, (x + 0.5) / kSampleSide, (y + 0.5) / kSampleSide);
            draw_dot(out, above, {h.x, h.y}, 1.8, "c4");
        }
    draw_table(out, "half vectors by random numbers", 2.0 * kGap + kSide, [&](double x, double y) {
        const PhongHalfVector h = phong_half_vector(nu, nv, x, y);
        return paint_of(0.5 + 0.5 * h.x, 0.5 + 0.5 * h.y, h.z);
    });
    draw_table(out, "albedo: red f0, green besides", 3.0 * kGap + 2.0 * kSide, [&](double x, double y) {
        const double n_dot_v = std::max(y * y, 1e-4), sine = std::sqrt(1.0 - n_dot_v * n_dot_v), azimuth = 0.5 * kPi * x;
        const PhongAlbedo of = phong_albedo({sine * std::cos(azimuth), sine * std::sin(azimuth), n_dot_v}, nu, nv, 144, 89);
        return paint_of(of.s, of.b, 0.0);
    });
    out.text(kGap, kTop + kSide + 44.0, "note",
             fmt::format("alpha_lin {:g}, eta {:g}: exponents {:.4g} along the tangent and {:.4g} across; {} samples of a grid",
                         lobe.roughness, lobe.anisotropy, nu, nv, kSampleSide * kSampleSide));
    out.text(kGap, kTop + kSide + 68.0, "note", "to the right and up: both random numbers; the eye's azimuth and the root of its cosine");
    return out;
}

} // namespace burnish
