#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <string>

#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "core/math/scalar_math.h"
#include "shading/bake/tables/phong.h"

namespace burnish {
namespace {

constexpr int kSampleSide = 16, kCells = 50; // samples and cells along each side

// Draws a colour table over [0,1]^2, x to the right and y up.
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

// Returns the energy share lost by a white dielectric with this lobe and the diffuse term of Ashikhmin and Shirley.
double energy_lost(double nu, double nv, double theta, double azimuth, double f0)
{
    const double sine = std::sin(theta), n_dot_v = std::max(std::cos(theta), 1e-4);
    const PhongAlbedo a = phong_albedo({sine * std::cos(azimuth), sine * std::sin(azimuth), n_dot_v}, nu, nv, 144, 89);
    const double rise = 1.0 - std::pow(1.0 - 0.5 * n_dot_v, 5.0);
    return 1.0 - (f0 * a.s + a.b) - (1.0 - f0) * rise;
}

} // namespace

Drawing plot_energy()
{
    constexpr double kThetas[] = {0.0, 45.0, 70.0, 85.0}, kAzimuth = 45.0 * kDegree, kF0 = 0.04, kMost = 0.5;
    Drawing out(4.0 * kSide + 5.0 * kGap, kTop + kSide + kBelow, "chart", "Light that Ashikhmin and Shirley's surface loses");
    std::string note;
    for (int k = 0; k < 4; ++k) {
        double least = 1.0, most = -1.0;
        const std::string title = fmt::format("seen from {:g} degrees", kThetas[k]);
        draw_table(out, title.c_str(), kGap + k * (kSide + kGap), [&](double x, double y) {
            const double lost = energy_lost(std::pow(10.0, 5.0 * x), std::pow(10.0, 5.0 * y), kThetas[k] * kDegree, kAzimuth, kF0);
            least = std::min(least, lost), most = std::max(most, lost);
            const double part = lost / kMost;
            return lost < 0.0 ? paint_of(0.2, 0.4, 1.0) : paint_of(1.0 - 0.3 * part, 1.0 - 0.9 * part, 1.0 - part);
        });
        note += fmt::format("{}{:g}: {:.3f} to {:.3f}", k ? ", " : "share lost from ", kThetas[k], least, most);
    }
    out.text(kGap, kTop + kSide + 44.0, "note", note);
    out.text(kGap, kTop + kSide + 68.0, "note",
             fmt::format(
                 "to the right and up: exponents nu and nv from 1 to 100000, on logarithmic axes; f0 {:g}, white; seen from 45 degrees off "
                 "the tangent; white: no loss, red: {:g}, blue: a gain",
                 kF0, kMost));
    return out;
}

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
             fmt::format("roughness {:g}, eta {:g}: exponents {:.4g} along the tangent and {:.4g} across; {} samples of a grid",
                         lobe.roughness, lobe.anisotropy, nu, nv, kSampleSide * kSampleSide));
    out.text(kGap, kTop + kSide + 68.0, "note", "to the right and up: both random numbers; the eye's azimuth and the root of its cosine");
    return out;
}

} // namespace burnish
