#include "shading/lab/ltc/lobe.h"

#include <algorithm>

#include "core/math/scalar_math.h"

namespace burnish::ltc {
namespace {

double shadow(double alpha_x, double alpha_y, const Vec& w)
{
    const double x = alpha_x * w.x, y = alpha_y * w.y;
    return 0.5 * (std::sqrt(1.0 + (x * x + y * y) / (w.z * w.z)) - 1.0);
}

// Lambda for Beckmann normals, by the rational fit in Walter et al. 2007.
double beckmann_shadow(double alpha_x, double alpha_y, const Vec& w)
{
    const double x = alpha_x * w.x, y = alpha_y * w.y, s = std::sqrt(x * x + y * y);
    if (!(w.z < 1.6 * s))
        return 0.0;
    const double c = w.z / s;
    return (1.0 - 1.259 * c + 0.396 * c * c) / (3.535 * c + 2.181 * c * c);
}

// Returns the BRDF without Fresnel times the cosine, for models other than GGX. l is above the horizon, h = v + l.
double reflected_by(const Lobe& lobe, const Vec& l, const Vec& h)
{
    constexpr double kLeastCosine = 1e-4; // in denominators
    const double x = h.x / lobe.alpha_x, y = h.y / lobe.alpha_y, z2 = h.z * h.z, length2 = dot(h, h), across2 = h.x * h.x + h.y * h.y;
    const double unit_z2 = z2 / length2;
    switch (lobe.model) {
    case Model::beckmann: {
        const double smooth = det_exp(-(x * x + y * y) / z2) / (unit_z2 * unit_z2);
        return smooth * lobe.scale / (1.0 + lobe.shadow_model_v + beckmann_shadow(lobe.alpha_x, lobe.alpha_y, l));
    }
    case Model::ashikhmin_shirley: {
        const double nu = 1.0 / (lobe.alpha_x * lobe.alpha_x), nv = 1.0 / (lobe.alpha_y * lobe.alpha_y);
        const double exponent = across2 > 0.0 ? (nu * h.x * h.x + nv * h.y * h.y) / across2 : 0.0;
        const double of_half = std::sqrt((nu + 1.0) * (nv + 1.0)) / (2.0 * kPi) * det_exp(0.5 * exponent * det_log(unit_z2));
        return of_half * l.z / (2.0 * std::sqrt(length2) * std::max(std::max(lobe.v.z, l.z), kLeastCosine));
    }
    case Model::ward: {
        const double roots = std::sqrt(std::max(lobe.v.z, kLeastCosine)) * std::sqrt(std::max(l.z, kLeastCosine));
        return det_exp(-(x * x + y * y) / z2) * lobe.scale * lobe.v.z / roots * l.z;
    }
    case Model::ggx: // see density()
        break;
    }
    return 0.0;
}

} // namespace

Lobe::Lobe(const Place& place, double white, Model of)
    : v(eye_of(place)), alpha_x(place.alpha), alpha_y(place.alpha * place.lambda), albedo(white), model(of)
{
    shadow_v = shadow(alpha_x, alpha_y, v);
    shadow_model_v = beckmann_shadow(alpha_x, alpha_y, v);
    scale = 1.0 / (4.0 * kPi * alpha_x * alpha_y * v.z);
}

Reflected density(const Lobe& lobe, const Vec& l)
{
    const Vec h = {lobe.v.x + l.x, lobe.v.y + l.y, lobe.v.z + l.z};
    if (!(h.z > 0.0))
        return {0.0, 0.0};
    const double x = h.x / lobe.alpha_x, y = h.y / lobe.alpha_y, length2 = dot(h, h), s = x * x + y * y + h.z * h.z;
    const double ratio = length2 / s, d = ratio * ratio * lobe.scale;
    Reflected r = {d / (1.0 + lobe.shadow_v), 0.0};
    if (l.z > 0.0)
        r.reflected = lobe.model == Model::ggx ? d / ((1.0 + lobe.shadow_v + shadow(lobe.alpha_x, lobe.alpha_y, l)) * lobe.albedo)
                                               : reflected_by(lobe, l, h) / lobe.albedo;
    return r;
}

Rule::Rule(int k)
{
    int count = 1, before = 1;
    for (int i = 2; i < k; ++i) {
        const int next = count + before;
        before = count, count = next;
    }
    for (int i = 0; i < count; ++i) {
        const long turn = static_cast<long>(i) * before % count;
        const double u = (i + 0.5) / count, azimuth = 2.0 * kPi * static_cast<double>(turn) / count;
        const double c = det_cos(azimuth), s = det_sin(azimuth), radius = std::sqrt(u);
        points.push_back({u, c, s, {radius * c, radius * s, std::sqrt(1.0 - u)}});
    }
}

Vec mirrored_normal(const Lobe& lobe, const Rule::Point& point)
{
    const Vec w = unit({lobe.alpha_x * lobe.v.x, lobe.alpha_y * lobe.v.y, lobe.v.z});
    const double z = 1.0 - point.depth * (1.0 + w.z), radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    const Vec h =
        unit({lobe.alpha_x * (radius * point.cosine + w.x), lobe.alpha_y * (radius * point.sine + w.y), std::max(z + w.z, 1e-300)});
    const double twice = 2.0 * dot(lobe.v, h);
    return {twice * h.x - lobe.v.x, twice * h.y - lobe.v.y, twice * h.z - lobe.v.z};
}

Albedo albedo(const Lobe& lobe, const Rule& rule)
{
    Albedo sum = {0.0, 0.0};
    for (const Rule::Point& point : rule.points) {
        const Vec l = mirrored_normal(lobe, point);
        if (!(l.z > 0.0))
            continue;
        double g = 0.0;
        if (lobe.model == Model::ggx) {
            g = (1.0 + lobe.shadow_v) / (1.0 + lobe.shadow_v + shadow(lobe.alpha_x, lobe.alpha_y, l));
        } else if (const Reflected f = density(lobe, l); f.visible > 0.0) {
            g = f.reflected * lobe.albedo / f.visible;
        }
        const double m = std::max(0.0, 1.0 - std::sqrt(std::max(0.0, 0.5 * (1.0 + dot(lobe.v, l))))), m2 = m * m;
        sum.all += g;
        sum.grazing += g * m2 * m2 * m;
    }
    const double count = static_cast<double>(rule.points.size());
    return {sum.all / count, sum.grazing / count};
}

Lobe normalised_lobe(const Place& place, const Rule& rule, Model model)
{
    return Lobe(place, albedo(Lobe(place, 1.0, model), rule).all, model);
}

double transformed_cosine(const Matrix& n, const Vec& l)
{
    const Vec u = n * l;
    if (!(u.z > 0.0))
        return 0.0;
    const double length2 = dot(u, u);
    return u.z * std::abs(determinant(n)) / (kPi * length2 * length2);
}

Matrix in_natural_gauge(const Matrix& m, const Place& place)
{
    Matrix r = m;
    if (determinant(r) < 0.0)
        r[1] = -r[1], r[4] = -r[4], r[7] = -r[7];
    const Matrix natural = natural_matrix(place);
    double b[2][2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec column = unit({natural[i], natural[3 + i], natural[6 + i]});
        for (std::size_t j = 0; j < 2; ++j)
            b[i][j] = dot(column, {r[j], r[3 + j], r[6 + j]});
    }
    const double sine = b[0][1] - b[1][0], cosine = b[0][0] + b[1][1], length = std::sqrt(sine * sine + cosine * cosine);
    if (!(length > 0.0))
        return r;
    const double s = sine / length, c = cosine / length;
    for (std::size_t row = 0; row < 3; ++row) {
        const double a0 = r[3 * row], a1 = r[3 * row + 1];
        r[3 * row] = a0 * c + a1 * s;
        r[3 * row + 1] = a1 * c - a0 * s;
    }
    return r;
}

} // namespace burnish::ltc
