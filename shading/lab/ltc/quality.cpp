#include "shading/lab/ltc/quality.h"

#include <algorithm>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/interpolant_fit.h"
#include "shading/lab/ltc/pair_fit.h"
#include "shading/lab/ltc/polygon.h"

namespace burnish::ltc {
namespace {

using Quad = std::vector<Vec>;

Quad parallelogram(const Vec& middle, const Vec& a, const Vec& b) // a, b: half sides
{
    Quad quad;
    for (const auto& [s, t] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        quad.push_back({middle.x + s * a.x + t * b.x, middle.y + s * a.y + t * b.y, middle.z + s * a.z + t * b.z});
    return quad;
}

// Returns test quads around an eye's mirror direction, seen from the shading point.
std::vector<Quad> lights_of(const Vec& v)
{
    const Vec r = {-v.x, -v.y, v.z};
    const double flat = std::sqrt(v.x * v.x + v.y * v.y);
    const Vec ahead = flat > 1e-9 ? Vec{r.x / flat, r.y / flat, 0.0} : Vec{-1.0, 0.0, 0.0}, across = {-ahead.y, ahead.x, 0.0};
    const Vec up = cross(r, across); // completes a frame with `across` and r
    return {
        parallelogram({0.3, 0.2, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}),
        parallelogram({ahead.x, ahead.y, 0.25}, scaled(across, 1.0), {0.0, 0.0, 0.75}),
        parallelogram(r, scaled(across, 0.15), scaled(up, 0.15)),
        parallelogram(r, scaled(across, 0.5), scaled(up, 0.02)),
        parallelogram({r.x + 20.0 * across.x, r.y + 20.0 * across.y, r.z + 20.0 * across.z}, scaled(across, 20.0), scaled(up, 20.0)),
        parallelogram({2.0 * ahead.x, 2.0 * ahead.y, 0.1}, scaled(across, 2.0), {0.0, 0.0, 0.1}),
    };
}

struct Cone { // cone of a quad: l lies inside all planes
    explicit Cone(const Quad& quad)
    {
        Vec middle = {0.0, 0.0, 0.0};
        for (const Vec& p : quad)
            middle = {middle.x + p.x, middle.y + p.y, middle.z + p.z};
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec n = cross(quad[i], quad[(i + 1) % 4]);
            planes[i] = dot(n, middle) < 0.0 ? scaled(n, -1.0) : n;
        }
    }
    bool holds(const Vec& l) const
    {
        return dot(planes[0], l) > 0.0 && dot(planes[1], l) > 0.0 && dot(planes[2], l) > 0.0 && dot(planes[3], l) > 0.0;
    }
    Vec planes[4];
};

struct Differences {
    double l1 = 0.0, lights[kLights] = {};
};

// Integrates |p - q|, and p - q over cones, with points from both densities. The difference is small where both are large, so it gives the
// cones' light much more accurately than p alone.
Differences differences(const Lobe& lobe, const Matrix& m, const std::vector<Cone>& cones, const Rule& rule)
{
    Differences sum;
    const Matrix n = inverse(m);
    const auto add = [&](const Vec& l) {
        const Reflected f = density(lobe, l);
        const double q = transformed_cosine(n, l), both = f.visible + q;
        if (!(both > 0.0))
            return;
        const double d = (f.reflected - q) / both;
        sum.l1 += std::abs(d);
        for (std::size_t i = 0; i < cones.size(); ++i)
            if (cones[i].holds(l))
                sum.lights[i] += d;
    };
    for (const Rule::Point& point : rule.points) {
        add(mirrored_normal(lobe, point));
        add(unit(m * point.clamped));
    }
    const double share = 1.0 / static_cast<double>(rule.points.size());
    sum.l1 *= share;
    for (double& light : sum.lights)
        light *= share;
    return sum;
}

// Judges one lobe. looked: the approximation.
Judged judged(const Place& place, const Looked& looked, Model model, int cosines, const Rule& rule)
{
    static const Rule fit_rule(15);
    Judged j;
    j.place = place;
    Lobe lobe(place, 1.0, model);
    const Albedo white = albedo(lobe, rule);
    lobe.albedo = white.all;
    const std::vector<Quad> quads = lights_of(lobe.v);
    std::vector<Cone> cones(quads.begin(), quads.end());
    const Differences d = differences(lobe, looked.m, cones, rule);
    j.l1 = d.l1;
    for (std::size_t i = 0; i < kLights; ++i) {
        const double part = polygon_part(inverse(looked.m), quads[i]), exact = part + d.lights[i];
        j.light_absolute[i] = std::abs(d.lights[i]);
        j.light_relative[i] = std::abs(d.lights[i]) / std::max(exact, 0.02);
    }
    j.all_relative = std::abs(looked.all - white.all) / white.all;
    j.grazing_absolute = std::abs(looked.grazing - white.grazing);
    // Fit this lobe alone, and with a pair
    if (cosines > 0) {
        const LobePoints points(lobe, fit_rule);
        NodeFit best = fit_lobe(points, natural_matrix(place), 0);
        if (determinant(looked.m) > 0.0)
            if (const NodeFit other = fit_lobe(points, looked.m, 0); other.l1 < best.l1)
                best = other;
        j.pair_l1 = j.best_l1 = differences(lobe, best.m, {}, rule).l1;
        if (cosines == 2 && j.best_l1 > kFarOff)
            j.pair_l1 = std::min(j.best_l1, l1_of_pair(LobePoints(lobe, rule), fit_pair(points, best.m)));
    }
    return j;
}

struct Moments {
    double sum = 0.0, squares = 0.0;
    void add(double v) { sum += v, squares += v * v; }
    double deviation(double count) const // standard deviation over the mean
    {
        const double mean = sum / count;
        return mean > 0.0 ? std::sqrt(std::max(squares / count - mean * mean, 0.0)) / mean : 0.0;
    }
};

Sampled sampled(const Table& table, const Place& place, const Rule& rule)
{
    Sampled r;
    r.place = place;
    const Lobe lobe = normalised_lobe(place, rule, table.model());
    const Matrix m = lookup(table, place).m, n = inverse(m);
    const std::vector<Quad> quads = lights_of(lobe.v);
    const std::vector<Cone> cones(quads.begin(), quads.end());
    const double count = static_cast<double>(rule.points.size());
    Moments even[2], lit[kSamplers][kLights];
    const auto add = [&](Sampler sampler, const Vec& l, double value) {
        even[sampler].add(value);
        for (std::size_t i = 0; i < kLights; ++i)
            lit[sampler][i].add(cones[i].holds(l) ? value : 0.0);
    };
    // Sample the lobe in three ways
    for (const Rule::Point& point : rule.points) {
        const Vec l = unit(m * point.clamped), h = mirrored_normal(lobe, point);
        add(kByCosine, l, density(lobe, l).reflected / transformed_cosine(n, l));
        const Reflected f = density(lobe, h);
        add(kByVisibleNormals, h, f.visible > 0.0 ? f.reflected / f.visible : 0.0);
        r.unseen += f.visible > 0.0 && !(transformed_cosine(n, h) > 0.0) ? f.reflected / f.visible / count : 0.0;
        const double v = det_atan2(point.sine, point.cosine) / (2.0 * kPi) + 0.5;
        for (std::size_t i = 0; i < kLights; ++i) {
            const Quad& q = quads[i];
            const Vec a = {q[1].x - q[0].x, q[1].y - q[0].y, q[1].z - q[0].z}, b = {q[3].x - q[0].x, q[3].y - q[0].y, q[3].z - q[0].z};
            const Vec at = {q[0].x + point.depth * a.x + v * b.x, q[0].y + point.depth * a.y + v * b.y,
                            q[0].z + point.depth * a.z + v * b.z},
                      to = unit(at);
            const double over = std::abs(dot(cross(a, b), to)) / dot(at, at); // solid angle per sample
            lit[kByArea][i].add(density(lobe, to).reflected * over);
        }
    }
    r.furnace[kByCosine] = even[kByCosine].deviation(count), r.furnace[kByVisibleNormals] = even[kByVisibleNormals].deviation(count);
    for (std::size_t i = 0; i < kLights; ++i)
        for (int s = 0; s < kSamplers; ++s)
            r.lights[s][i] = lit[kByVisibleNormals][i].sum < kLeastSampled * count ? -1.0 : lit[s][i].deviation(count);
    return r;
}

} // namespace

std::vector<Place> judged_places(std::size_t count, std::size_t on_nodes, std::size_t from)
{
    std::vector<Place> places;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<double, 4> u = spread_point(from + i);
        if (i < on_nodes) {
            const auto step = [](double v, int least, int most) { return least + std::floor(v * (most - least + 1)); };
            places.push_back(
                {step(u[0], 0, 6) / 7.0 * 0.5 * kPi, step(u[1], 0, 7) / 7.0 * 0.5 * kPi, step(u[2], 1, 7) / 7.0, step(u[3], 1, 7) / 7.0});
            continue;
        }
        const double alpha = i % 2 == 0 ? 0.05 + 0.95 * u[2] : det_exp(det_log(0.05) * (1.0 - u[2]));
        places.push_back({u[0] * 85.0 / 180.0 * kPi, u[1] * 0.5 * kPi, alpha, 0.1 + 0.9 * u[3]});
    }
    return places;
}

std::vector<Place> grazing_places(std::size_t count)
{
    std::vector<Place> places = judged_places(count, 0, 3000);
    for (Place& place : places)
        place.theta = (75.0 + 14.0 / 85.0 * (place.theta * 180.0 / kPi)) / 180.0 * kPi;
    return places;
}

std::vector<Judged> judge(const Table& table, const std::vector<Place>& places, int cosines, const Jobs& jobs)
{
    const Rule rule(22);
    std::vector<Judged> all(places.size());
    jobs.parallel_for(places.size(),
                      [&](std::size_t i, int) { all[i] = judged(places[i], lookup(table, places[i]), table.model(), cosines, rule); });
    return all;
}

std::vector<Judged> judge_matrices(const std::vector<Place>& places, const std::vector<Matrix>& matrices, const Jobs& jobs)
{
    const Rule rule(22);
    std::vector<Judged> all(places.size());
    jobs.parallel_for(places.size(), [&](std::size_t i, int) { all[i] = judged(places[i], {matrices[i], 0.0, 0.0}, Model::ggx, 0, rule); });
    return all;
}

std::vector<Sampled> judge_sampling(const Table& table, const std::vector<Place>& places, const Jobs& jobs)
{
    const Rule rule(19);
    std::vector<Sampled> all(places.size());
    jobs.parallel_for(places.size(), [&](std::size_t i, int) { all[i] = sampled(table, places[i], rule); });
    return all;
}

double light_of_quad(const Lobe& lobe, const Matrix& near, const std::vector<Vec>& quad, const Rule& rule)
{
    return polygon_part(inverse(near), quad) + differences(lobe, near, {Cone(quad)}, rule).lights[0];
}

Spread spread_of(std::vector<double> values)
{
    if (values.empty())
        return {};
    std::sort(values.begin(), values.end());
    Spread s;
    for (double v : values)
        s.mean += v / static_cast<double>(values.size());
    const auto at = [&](double part) { return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)]; };
    s.median = at(0.5), s.p95 = at(0.95), s.most = values.back();
    return s;
}

std::vector<double> l1_of_cells(const Table& table, const Jobs& jobs)
{
    const Rule rule(15), albedo_rule(17);
    const Grid grid = table.grid.round ? Grid() : table.grid; // provides the cells
    const std::vector<std::array<int, 4>> cells = grid.cells();
    std::vector<double> l1(cells.size());
    jobs.parallel_for(l1.size(), [&](std::size_t index, int) {
        const std::array<int, 4>& i = cells[index];
        const Place place = grid.between(i[0], i[1], i[2], i[3], {0.5, 0.5, 0.5, 0.5});
        const Matrix m = lookup(table, place).m;
        l1[index] = determinant(m) > 0.0 ? l1_distance(LobePoints(normalised_lobe(place, albedo_rule, table.model()), rule), m) : 2.0;
    });
    return l1;
}

std::size_t broken_lookups(const Table& table, std::size_t probes, const Jobs& jobs)
{
    constexpr std::size_t kChunk = 4096;
    std::vector<std::size_t> broken((probes + kChunk - 1) / kChunk, 0);
    jobs.parallel_for(broken.size(), [&](std::size_t c, int) {
        for (std::size_t i = c * kChunk; i < std::min(probes, (c + 1) * kChunk); ++i)
            broken[c] += determinant(lookup(table, usable_place(spread_point(i + 1000003), table.grid.most_alpha())).m) > 0.0 ? 0 : 1;
    });
    std::size_t sum = 0;
    for (std::size_t b : broken)
        sum += b;
    return sum;
}

} // namespace burnish::ltc
