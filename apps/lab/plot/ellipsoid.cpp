#include "apps/lab/plot/ellipsoid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "apps/lab/plot/panel.h"

namespace burnish {
namespace {

constexpr int kBinRows = 8, kBinColumns = 16; // histograms in cosine and azimuth
constexpr double kLeastExpected = 20.0;       // normals a bin; bins below are merged
constexpr int kDirections = 24;               // rows of directions for measuring areas
constexpr double kTiltDeg = 25.0;             // for measure_skew()
constexpr int kEnergySide = 96;               // samples along each side of the sample grid in measure_skew()

const EllipsoidFns& ellipsoid_fns()
{
    return FnsByIsa<EllipsoidFns>::oracle(nullptr);
}

PlotVec direction(double z, double phi)
{
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

PlotVec scaled(const PlotVec& v, double s)
{
    return {v.x * s, v.y * s, v.z * s};
}

PlotVec sum(const PlotVec& a, const PlotVec& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

// Calls `call` with the direction and solid angle of each cell on the upper hemisphere.
template <class Call> void each_normal(const Call& call)
{
    const double part = 2.0 * kPi / (static_cast<double>(kEllipsoidRows) * kEllipsoidColumns);
    for (int row = 0; row < kEllipsoidRows; ++row)
        for (int column = 0; column < kEllipsoidColumns; ++column)
            call(direction((row + 0.5) / kEllipsoidRows, 2.0 * kPi * (column + 0.5) / kEllipsoidColumns), part);
}

std::vector<PlotVec> directions()
{
    std::vector<PlotVec> out;
    for (int row = 0; row < kDirections; ++row)
        for (int column = 0; column < 2 * kDirections; ++column)
            out.push_back(direction((row + 0.5) / kDirections, kPi * (column + 0.5) / kDirections));
    return out;
}

class Random { // splitmix64
  public:
    double next()
    {
        std::uint64_t x = state_ += 0x9e3779b97f4a7c15ull;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ x >> 27) * 0x94d049bb133111ebull;
        return static_cast<double>((x ^ x >> 31) >> 11) * 0x1p-53;
    }

  private:
    std::uint64_t state_ = 1;
};

struct Axes { // two unit directions perpendicular to a third
    PlotVec a, b;
};
Axes across(const PlotVec& w)
{
    const PlotVec a = unit(cross(w, std::abs(w.z) < 0.9 ? PlotVec{0, 0, 1} : PlotVec{1, 0, 0}));
    return {a, cross(w, a)};
}

// Returns a random point on the disk with this radius perpendicular to w.
PlotVec disk_point(Random& random, const PlotVec& w, double radius)
{
    const double r = radius * std::sqrt(random.next()), phi = 2.0 * kPi * random.next();
    const Axes axes = across(w);
    return sum(scaled(axes.a, r * std::cos(phi)), scaled(axes.b, r * std::sin(phi)));
}

bool is_seen(const PlotVec& m, const PlotVec& eye)
{
    return m.z >= 0.0 && dot(m, eye) >= 0.0;
}

// Draw one normal by each version; return false for a rejection. The ellipsoid is |A p| = 1, with normals A^T A p.
bool from_sphere(const EllipsoidShape& s, const PlotVec& eye, Random& random, PlotVec& m)
{
    const PlotVec start = disk_point(random, eye, 1.0 / std::min({s.alpha_x, s.alpha_y, 1.0}));
    const PlotVec p = ellipsoid_fns().map(s, start), w = ellipsoid_fns().map(s, eye); // |p + t w| = 1
    const double a = dot(w, w), b = dot(p, w), c = dot(p, p) - 1.0, under = b * b - a * c;
    if (under < 0.0)
        return false;
    const double t = (-b + std::sqrt(under)) / a; // the side facing the eye
    m = unit(ellipsoid_fns().transposed(s, sum(p, scaled(w, t))));
    return is_seen(m, eye);
}

bool from_outline(const EllipsoidShape& s, const PlotVec& eye, Random& random, PlotVec& m)
{
    const PlotVec w = unit(ellipsoid_fns().map(s, eye)), disk = disk_point(random, w, 1.0);
    m = unit(ellipsoid_fns().transposed(s, sum(disk, scaled(w, std::sqrt(std::max(0.0, 1.0 - dot(disk, disk)))))));
    return is_seen(m, eye);
}

bool without_rejection(const EllipsoidShape& s, const PlotVec& eye, Random& random, PlotVec& m)
{
    const double x = random.next();
    m = ellipsoid_fns().sample(s, eye, x, random.next()).m;
    return true;
}

constexpr bool (*kVersions[])(const EllipsoidShape&, const PlotVec&, Random&, PlotVec&) = {from_sphere, from_outline, without_rejection};

using Bins = std::array<double, kBinRows * kBinColumns>;

std::size_t bin_of(const PlotVec& m)
{
    const double turn = std::atan2(m.y, m.x) / (2.0 * kPi);
    const int row = std::min(kBinRows - 1, static_cast<int>(m.z * kBinRows));
    const int column = std::min(kBinColumns - 1, static_cast<int>((turn < 0.0 ? turn + 1.0 : turn) * kBinColumns));
    return static_cast<std::size_t>(row * kBinColumns + column);
}

SamplerFigures measure_sampler(int version, const EllipsoidShape& shape, const PlotVec& eye, const Bins& expected)
{
    Random random;
    Bins found{};
    double tried = 0.0;
    for (int kept = 0; kept < kEllipsoidSamples; tried += 1.0) {
        PlotVec m{};
        if (!kVersions[version](shape, eye, random, m))
            continue;
        found[bin_of(m)] += 1.0;
        ++kept;
    }
    // Compare the histogram with the density, bins with few normals merged
    SamplerFigures figures;
    figures.kept = kEllipsoidSamples / tried;
    double rest_found = 0.0, rest_expected = 0.0;
    const auto add = [&figures](double f, double e) {
        if (e <= 0.0)
            return;
        figures.chi2 += (f - e) * (f - e) / e;
        ++figures.freedom;
    };
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double e = expected[i] * kEllipsoidSamples;
        if (e >= kLeastExpected) {
            add(found[i], e);
            continue;
        }
        rest_found += found[i], rest_expected += e;
    }
    add(rest_found, rest_expected);
    --figures.freedom;
    // Areas in units of the projected area of the ellipsoid part with normals above the horizon: pi |A n| / |det A|.
    const PlotVec an = ellipsoid_fns().map(shape, {0, 0, 1}), ao = ellipsoid_fns().map(shape, eye);
    const double smallest = std::min({shape.alpha_x, shape.alpha_y, 1.0}), det = shape.alpha_x * shape.alpha_y;
    const double seen = ellipsoid_fns().visible_area(shape, eye) * std::sqrt(dot(an, an)) / det;
    const double of[] = {1.0 / (smallest * smallest), std::sqrt(dot(ao, ao)) / det, seen};
    figures.kept_by_area = seen / of[version];
    return figures;
}

EllipsoidFigures measure(const EllipsoidShape& shape, const PlotVec& eye)
{
    EllipsoidFigures f;
    f.shape = shape, f.eye = eye;
    const std::vector<PlotVec> seen_from = directions();
    std::vector<double> areas(seen_from.size(), 0.0);
    Bins expected{};
    PlotVec mean = {0, 0, 0};
    int cell = 0;
    // Integrate the density over the upper hemisphere
    each_normal([&](const PlotVec& m, double part) {
        const double d = ellipsoid_fns().d(shape, m) * part;
        f.projected += d * m.z;
        mean = sum(mean, scaled(m, d));
        expected[bin_of(m)] += ellipsoid_fns().half_pdf(shape, eye, m) * part;
        if (++cell % 7 == 0) // areas need fewer normals
            for (std::size_t i = 0; i < areas.size(); i += 5)
                areas[i] += 7.0 * d * std::max(0.0, dot(m, seen_from[i]));
    });
    f.mean = unit(mean);
    f.mean_by_shape = unit(ellipsoid_fns().transposed(shape, ellipsoid_fns().map(shape, {0, 0, 1})));
    // Compare visible areas over directions, without and with the wall
    const PlotVec wall = {-mean.x, -mean.y, 0.0}; // with this wall, the mean of all normals is the surface normal
    f.wall = std::sqrt(dot(wall, wall));
    f.least_visible = f.least_with_wall = 1e30;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const PlotVec& u = seen_from[i];
        const double area = ellipsoid_fns().visible_area(shape, u);
        if (i % 5 == 0)
            f.area_error = std::max(f.area_error, std::abs(areas[i] - area));
        f.clamped += area < u.z * (1.0 - 1e-12) ? 1.0 / static_cast<double>(areas.size()) : 0.0;
        f.least_visible = std::min(f.least_visible, area / u.z);
        f.least_with_wall = std::min(f.least_with_wall, (area + std::max(0.0, dot(wall, u))) / u.z);
    }
    for (int version = 0; version < 3; ++version)
        f.samplers[version] = measure_sampler(version, shape, eye, expected);
    return f;
}

} // namespace

std::vector<EllipsoidFigures> measure_ellipsoids()
{
    constexpr EllipsoidShape kSettings[] = {
        {0.3, 0.5, 0.0, 0.0, 0.0}, {0.3, 0.6, 0.1, -0.08, 0.9}, {0.2, 0.6, 0.25, -0.3, 0.7}, {0.7, 0.15, -0.4, 0.2, 1.9}};
    const PlotVec eyes[] = {unit({0.5, -0.2, 0.7}), unit({0.3, 0.2, 0.9}), unit({0.6, 0.3, 0.4}), unit({0.0, 0.9, 0.1})};
    std::vector<EllipsoidFigures> figures;
    for (std::size_t i = 0; i < std::size(kSettings); ++i)
        figures.push_back(measure(kSettings[i], eyes[i]));
    return figures;
}

std::vector<EnergyRow> measure_skew()
{
    const EllipsoidShape shape = {0.25, 0.25, kTiltDeg * kPi / 180.0, 0.0, 0.0};
    const PlotVec peak = ellipsoid_fns().peak(shape), t = {1, 0, 0}, b = cross(peak, t);
    std::vector<EnergyRow> rows;
    for (int degrees = -85; degrees <= 85; degrees += 5) {
        const double theta = degrees * kPi / 180.0;
        const PlotVec light = {0.0, std::sin(theta), std::cos(theta)};
        const PlotVec turned = {dot(light, t), dot(light, b), dot(light, peak)};
        EnergyRow row = {static_cast<double>(degrees), 0.0, 0.0};
        for (int i = 0; i < kEnergySide; ++i)
            for (int k = 0; k < kEnergySide; ++k) {
                const double x = (i + 0.5) / kEnergySide, y = (k + 0.5) / kEnergySide;
                row.skew += ellipsoid_fns().sample(shape, light, x, y).weight;
                if (turned.z <= 0.0)
                    continue;
                // Energy leaving the surface uses the surface's own cosines; the weights are in the rotated frame.
                const NormalSample s = ellipsoid_fns().upright(shape, turned, x, y);
                const PlotVec out = sum(sum(scaled(t, s.wi.x), scaled(b, s.wi.y)), scaled(peak, s.wi.z));
                if (out.z > 0.0 && s.wi.z > 0.0)
                    row.normal_map += s.weight * out.z / s.wi.z * turned.z / light.z;
            }
        row.skew /= kEnergySide * kEnergySide, row.normal_map /= kEnergySide * kEnergySide;
        rows.push_back(row);
    }
    return rows;
}

} // namespace burnish
