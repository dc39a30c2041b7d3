#include "tests/unit/reference/formulas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burnish::test {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

} // namespace

glm::dvec3 coloured_sky(const glm::dvec3& direction)
{
    static const glm::dvec3 kSides[3] = {glm::normalize(glm::dvec3(1.0, 0.3, 0.5)), glm::normalize(glm::dvec3(-0.4, 1.0, 0.2)),
                                         glm::normalize(glm::dvec3(0.2, -0.9, -0.3))};
    static const glm::dvec3 kPeaks[3] = {glm::normalize(glm::dvec3(-0.5, 0.2, 0.8)), glm::normalize(glm::dvec3(0.3, -0.6, 0.6)),
                                         glm::normalize(glm::dvec3(0.5, 0.8, -0.2))};
    glm::dvec3 c;
    for (int k = 0; k < 3; ++k)
        c[k] = 1.0 + 0.8 * glm::dot(direction, kSides[k]) + 2.0 * std::exp((6.0 - k) * (glm::dot(direction, kPeaks[k]) - 1.0));
    return c;
}

glm::dvec3 white_sky(const glm::dvec3&)
{
    return glm::dvec3(1.0);
}

glm::dvec3 sky_upside_down(const glm::dvec3& d)
{
    return coloured_sky({d.x, d.y, -d.z});
}

Facets gltf_facets(double roughness, double strength, double rotation)
{
    const double alpha = roughness * roughness, a = rotation / 360.0 * kTwoPi;
    Facets f;
    f.along = alpha + (1.0 - alpha) * strength * strength, f.across = alpha;
    f.axes = glm::dmat3(glm::dvec3(std::cos(a), std::sin(a), 0.0), glm::dvec3(-std::sin(a), std::cos(a), 0.0), glm::dvec3(0.0, 0.0, 1.0));
    return f;
}

Facets tilted_by(Facets f, double x, double y)
{
    const glm::dmat3 about_x(1.0, 0.0, 0.0, 0.0, std::cos(x), std::sin(x), 0.0, -std::sin(x), std::cos(x));
    const glm::dmat3 about_y(std::cos(y), 0.0, -std::sin(y), 0.0, 1.0, 0.0, std::sin(y), 0.0, std::cos(y));
    f.axes = glm::transpose(about_x * about_y) * f.axes;
    return f;
}

namespace {

// Returns A u, where A turns directions to the axes and stretches them by the widths.
glm::dvec3 stretched(const Facets& f, const glm::dvec3& u)
{
    return glm::dvec3(f.along, f.across, 1.0) * (u * f.axes);
}

// Returns the GGX density (Heitz 2014) about the facets' normal.
double ggx_density(const Facets& f, const glm::dvec3& m)
{
    const glm::dvec3 w = (m * f.axes) / glm::dvec3(f.along, f.across, 1.0);
    return 1.0 / (std::numbers::pi * f.along * f.across * glm::dot(w, w) * glm::dot(w, w));
}

} // namespace

// Per surface area: the ellipsoid projects to |A n| of the unit sphere's area.
double facet_density(const Facets& f, const glm::dvec3& m)
{
    return ggx_density(f, m) / glm::length(stretched(f, {0.0, 0.0, 1.0}));
}

// Adds half of the ellipse visible from u to the part of its other half inside the surface's outline.
double area_seen(const Facets& f, const glm::dvec3& u)
{
    const glm::dvec3 au = stretched(f, u), an = stretched(f, {0.0, 0.0, 1.0});
    return 0.5 * (glm::length(au) + glm::dot(au, an) / glm::length(an)) / glm::length(an);
}

// Returns 1 / G1: 1 + Lambda of GGX (Heitz 2014), or, for tilted facets, Walter et al. 2014, eq. 6.
double inverse_g1(const Facets& f, const glm::dvec3& u)
{
    if (!f.level())
        return std::max(1.0, area_seen(f, u) / u.z);
    const double x = f.along * glm::dot(f.axes[0], u), y = f.across * glm::dot(f.axes[1], u);
    return 1.0 + 0.5 * (std::sqrt(1.0 + (x * x + y * y) / (u.z * u.z)) - 1.0);
}

namespace {

double g2(const Facets& f, const glm::dvec3& o, const glm::dvec3& i)
{
    const double a = inverse_g1(f, o), b = inverse_g1(f, i);
    return f.correlated ? 1.0 / (a + b - 1.0) : 1.0 / (a * b);
}

// Returns the BRDF without the Fresnel factor.
double facet_brdf(const Facets& f, const glm::dvec3& o, const glm::dvec3& i)
{
    return facet_density(f, glm::normalize(o + i)) * g2(f, o, i) / (4.0 * o.z * i.z);
}

} // namespace

// Normals follow the GGX density. An ellipsoid has as many opposite normals, which replace those below the surface.
void for_each_facet(const Facets& f, int rings, const std::function<void(const glm::dvec3&, double)>& add)
{
    const int turns = 2 * rings;
    for (int a = 0; a < rings; ++a)
        for (int b = 0; b < turns; ++b) {
            const double c = (a + 0.5) / rings, slope = std::sqrt(1.0 - c * c) / c, phi = (b + 0.5) / turns * kTwoPi;
            const glm::dvec3 m =
                glm::normalize(f.axes * glm::dvec3(f.along * slope * std::cos(phi), f.across * slope * std::sin(phi), 1.0));
            add(m.z < 0.0 ? -m : m, 2.0 * c / (rings * turns) / (ggx_density(f, m) * glm::dot(m, f.axes[2])));
        }
}

glm::dvec3 reflected_light(const Facets& f, const glm::dvec3& o, const Fresnel& fresnel, Sky sky, int rings)
{
    glm::dvec3 sum(0.0);
    for_each_facet(f, rings, [&](const glm::dvec3& m, double solid_angle) {
        const double cosine = glm::dot(o, m);
        const glm::dvec3 i = 2.0 * cosine * m - o;
        if (cosine > 0.0 && i.z > 0.0) // the light's solid angle is 4 (o.m) times the normal's
            sum += fresnel(cosine) * sky(i) * (facet_brdf(f, o, i) * i.z * 4.0 * cosine * solid_angle);
    });
    return sum;
}

glm::dvec3 diffuse_light(const glm::dmat3& axes, double lowest)
{
    constexpr int kRings = 256, kTurns = 512;
    glm::dvec3 sum(0.0);
    for (int a = 0; a < kRings; ++a)
        for (int b = 0; b < kTurns; ++b) {
            const double sine = std::sqrt((a + 0.5) / kRings), phi = (b + 0.5) / kTurns * kTwoPi;
            const glm::dvec3 i = axes * glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1.0 - sine * sine));
            if (i.z > lowest)
                sum += coloured_sky(i);
        }
    return sum / static_cast<double>(kRings * kTurns);
}

Fresnel schlick_of(const glm::dvec3& f0)
{
    return [f0](double cosine) { return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0); };
}

Fresnel no_fresnel()
{
    return [](double) { return glm::dvec3(1.0); };
}

Fresnel fresnel_of(double index)
{
    return [index](double cosine) {
        const double sine2 = (1.0 - cosine * cosine) / (index * index);
        if (sine2 >= 1.0)
            return glm::dvec3(1.0);
        const double inside = std::sqrt(1.0 - sine2);
        const double s = (cosine - index * inside) / (cosine + index * inside), p = (index * cosine - inside) / (index * cosine + inside);
        return glm::dvec3(0.5 * (s * s + p * p));
    };
}

// Walter et al. 2007, eq. 20 and 21.
glm::dvec3 glass_light(const Facets& f, const glm::dvec3& o, double index, const glm::dvec3& tint, Sky sky)
{
    const Fresnel fresnel = fresnel_of(index);
    glm::dvec3 sum = reflected_light(f, o, fresnel, sky);
    for_each_facet(f, 2 * kFacetRings, [&](const glm::dvec3& m, double solid_angle) {
        const double cosine = glm::dot(o, m), sine2 = (1.0 - cosine * cosine) / (index * index);
        if (cosine <= 0.0 || m.z <= 0.0 || sine2 >= 1.0)
            return;
        const double inside = std::sqrt(1.0 - sine2);
        const glm::dvec3 i = (cosine / index - inside) * m - o / index;
        if (i.z >= 0.0)
            return;
        const double across = index * glm::dot(i, m) + cosine;
        const double btdf = inside * cosine / (o.z * -i.z) * g2(f, o, -i) * facet_density(f, m) / (across * across);
        const double light_over_normal = across * across / (index * index * inside); // solid angles
        sum += tint * sky(i) * (1.0 - fresnel(cosine)) * (index * index * btdf * -i.z * light_over_normal * solid_angle);
    });
    return sum;
}

} // namespace burnish::test
