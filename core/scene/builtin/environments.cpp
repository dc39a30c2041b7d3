// Environments made in code. A white wall in ordinary light has a radiance of about 1.
#include <cmath>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr int kWidth = 1024, kHeight = 512;

glm::dvec3 mix(const glm::dvec3& a, const glm::dvec3& b, double t)
{
    return a * (1.0 - t) + b * t;
}

glm::dvec3 unit(const glm::dvec3& v)
{
    return v / std::sqrt(glm::dot(v, v));
}

// Evaluates radiance(direction) at every pixel centre, oriented as in shading/bake/environment/environment.h.
template <class Radiance> Image paint(const Jobs* jobs, const Radiance& radiance)
{
    std::vector<glm::dvec2> around(kWidth); // (x, z) of each column
    for (int column = 0; column < kWidth; ++column) {
        const double phi = ((column + 0.5) / kWidth - 0.5) * 2.0 * kPi;
        around[static_cast<std::size_t>(column)] = {det_cos(phi), det_sin(phi)};
    }
    Image image = make_image(kWidth, kHeight, 3, PixelType::f32);
    const auto paint_row = [&](std::size_t row, int) {
        const double theta = (static_cast<double>(row) + 0.5) / kHeight * kPi;
        const double s = det_sin(theta), c = det_cos(theta);
        float* out = image.f32() + row * kWidth * 3;
        for (const glm::dvec2& a : around) {
            const glm::dvec3 value = radiance(glm::dvec3(s * a.x, c, s * a.y));
            for (int k = 0; k < 3; ++k)
                *out++ = static_cast<float>(value[k]);
        }
    };
    if (jobs)
        jobs->parallel_for_whole(kHeight, paint_row);
    else
        for (std::size_t row = 0; row < kHeight; ++row)
            paint_row(row, 0);
    return image;
}

// A luminous rectangle seen from the origin, upright where its direction allows.
struct Panel {
    glm::dvec3 center, right, up;   // orthonormal
    double half_width, half_height; // tangents of the half angles
    double edge;                    // fade width, as a fraction of the half extents
    glm::dvec3 radiance;
};

Panel panel(double azimuth_deg, double elevation_deg, double half_width, double half_height, double edge, const glm::dvec3& radiance)
{
    const double a = azimuth_deg * kPi / 180.0, e = elevation_deg * kPi / 180.0;
    Panel p;
    // Azimuth 0 is +Z, the camera's default side; azimuth 90 is +X.
    p.center = {det_cos(e) * det_sin(a), det_sin(e), det_cos(e) * det_cos(a)};
    p.right = {det_cos(a), 0.0, -det_sin(a)};
    p.up = glm::cross(p.center, p.right);
    p.half_width = half_width;
    p.half_height = half_height;
    p.edge = edge;
    p.radiance = radiance;
    return p;
}

double panel_cover(const Panel& p, const glm::dvec3& d)
{
    const double ahead = glm::dot(d, p.center);
    if (ahead <= 0.01)
        return 0.0;
    const double right = std::fabs(glm::dot(d, p.right)), up = std::fabs(glm::dot(d, p.up));
    if (right >= ahead * p.half_width || up >= ahead * p.half_height) // x or y below is at least 1: most pixels are spared the rest
        return 0.0;
    const double x = right / (ahead * p.half_width), y = up / (ahead * p.half_height);
    return (1.0 - smooth_step(1.0 - p.edge, 1.0, x)) * (1.0 - smooth_step(1.0 - p.edge, 1.0, y));
}

} // namespace

Image make_studio(const Jobs* jobs)
{
    const glm::dvec3 neutral(1.0), warm(1.0, 0.72, 0.45), cool(0.55, 0.75, 1.0);
    const std::vector<Panel> panels = {
        panel(-48.0, 38.0, 0.48, 0.36, 0.30, neutral * 6.0),  // key, front left
        panel(20.0, 84.0, 0.42, 0.26, 0.40, neutral * 4.0),   // overhead
        panel(62.0, 12.0, 0.06, 0.95, 0.40, neutral * 14.0),  // strip, front right
        panel(112.0, 8.0, 0.10, 0.80, 0.40, cool * 10.0),     // strip, right behind
        panel(-118.0, 10.0, 0.12, 0.80, 0.40, warm * 10.0),   // strip, left behind
        panel(180.0, 42.0, 0.70, 0.06, 0.40, neutral * 24.0), // long strip, behind above
        panel(14.0, 18.0, 0.14, 0.10, 0.45, neutral * 3.5),   // small fill by the camera
    };
    return paint(jobs, [&panels](const glm::dvec3& d) {
        const double up = d.y;
        // Walls start at 0.012. They brighten towards the ceiling, and slightly below the horizon from light bounced
        // off the floor.
        double wall = 0.012 + 0.07 * smooth_step(-0.15, 1.0, up);
        wall += 0.03 * smooth_step(0.0, 0.5, -up) * (1.0 - 0.6 * smooth_step(0.5, 1.0, -up));
        glm::dvec3 value = glm::dvec3(1.0, 0.99, 0.97) * wall;
        for (const Panel& p : panels)
            value += p.radiance * panel_cover(p, d);
        return value;
    });
}

Image make_sky(const Jobs* jobs)
{
    constexpr double kSunRadius = 1.0 * kPi / 180.0; // radians; the real sun has 0.27 degrees
    constexpr double kSunRadiance = 9000.0;
    const glm::dvec3 sun = unit({-0.55, 0.62, 0.56});
    const glm::dvec3 zenith(0.10, 0.24, 0.62), horizon(0.78, 0.86, 0.96), sunlight(1.0, 0.93, 0.80);
    const glm::dvec3 earth(0.13, 0.11, 0.085), far_earth(0.34, 0.32, 0.30);
    return paint(jobs, [&](const glm::dvec3& d) {
        // 1 - cosine of the angle to the sun is angle^2 / 2 for small angles.
        const double away = std::fmax(0.0, 1.0 - glm::dot(d, sun)), angle = std::sqrt(2.0 * away);
        const double height = std::fmax(0.0, d.y), low = (1.0 - height) * (1.0 - height);
        glm::dvec3 air = mix(zenith, horizon, low * low);
        air += sunlight * (0.35 * (1.0 - height) / (1.0 + 12.0 * away)); // warm haze on the sun's side
        air += sunlight * (0.006 / (0.002 + away));                      // aureole
        const glm::dvec3 ground = mix(far_earth, earth, smooth_step(0.0, 0.6, -d.y));
        glm::dvec3 value = mix(ground, air, smooth_step(-0.012, 0.012, d.y));
        value += sunlight * (kSunRadiance * (1.0 - smooth_step(0.85 * kSunRadius, 1.15 * kSunRadius, angle)));
        return value;
    });
}

Image make_night(const Jobs* jobs)
{
    return paint(jobs, [](const glm::dvec3& d) { return glm::dvec3(0.003, 0.0035, 0.005) * (1.0 + 0.8 * d.y); });
}

} // namespace burnish
