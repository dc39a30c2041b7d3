#include "shading/bake/mipnet/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "core/base/check.h"
#include "core/image/metrics/flip.h"
#include "core/math/scalar_math.h"
#include "core/scene/dress.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mipnet/classical.h"
#include "shading/bake/mipnet/fallback.h"
#include "shading/bake/mipnet/pyramid.h"

namespace burnish::mipnet {
namespace {

constexpr int kPairs = 48, kTileTimes = 24, kSetups = 3, kLeastFlipSide = 16;
constexpr float kIntensity = 5.0f;

using Plane = std::vector<float>;

struct Directions { // planes of a level
    Plane to_light, to_eye, intensity;
};

Plane padded_plane(std::size_t count) // toned() takes whole slots
{
    return Plane((count + kSlots - 1) / kSlots * kSlots, 0.0f);
}

void put_direction(Plane& planes, std::size_t count, std::size_t at, double x, double y, double z)
{
    const double inverse = 1.0 / std::sqrt(x * x + y * y + z * z);
    planes[at] = static_cast<float>(x * inverse);
    planes[count + at] = static_cast<float>(y * inverse), planes[2 * count + at] = static_cast<float>(z * inverse);
}

// Pairs of a square of side x side: a light from anywhere above, an eye weighted by its cosine; the p-th of them for all texels, or where
// there are several tiles along a side, the next ones for one tile after the other.
Directions pair_of(int p, int side, int tiles)
{
    const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    Directions d = {Plane(3 * count), Plane(3 * count), Plane(count, kIntensity)};
    const int tile_side = side / tiles;
    for (int tile = 0; tile < tiles * tiles; ++tile) {
        Random random(1000003u * static_cast<std::uint64_t>(p + tile) + 17u);
        const double zi = random.between(0.1, 1.0), ti = random.between(0.0, 2.0 * kPi), zo = std::sqrt(random.between(0.01, 1.0)),
                     to = random.between(0.0, 2.0 * kPi);
        const double ri = std::sqrt(1.0 - zi * zi), ro = std::sqrt(std::max(1.0 - zo * zo, 0.0));
        const double i[] = {ri * det_cos(ti), ri * det_sin(ti), zi}, o[] = {ro * det_cos(to), ro * det_sin(to), zo};
        for (int y = 0; y < tile_side; ++y)
            for (int x = 0; x < tile_side; ++x) {
                const std::size_t at = static_cast<std::size_t>((tile / tiles * tile_side + y) * side + tile % tiles * tile_side + x);
                put_direction(d.to_light, count, at, i[0], i[1], i[2]), put_direction(d.to_eye, count, at, o[0], o[1], o[2]);
            }
    }
    return d;
}

// A lamp 1.5 away from the middle of the plane [-1, 1]^2, an eye far away near where the lamp is mirrored.
Directions setup_of(int setup, int side)
{
    constexpr double kLamps[kSetups][3] = {{0.0, 0.0, 1.5}, {0.75, 0.0, 1.3}, {0.3, 0.9, 1.16}};
    constexpr double kEyes[kSetups][3] = {{0.0, 0.0, 1.0}, {-0.45, 0.1, 0.89}, {-0.3, -0.5, 0.81}};
    const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    Directions d = {Plane(3 * count), Plane(3 * count), Plane(count)};
    const double *lamp = kLamps[setup], *eye = kEyes[setup];
    for (std::size_t at = 0; at < count; ++at) {
        const double x = (static_cast<double>(at % static_cast<std::size_t>(side)) + 0.5) / side * 2.0 - 1.0;
        const double y = (static_cast<double>(at / static_cast<std::size_t>(side)) + 0.5) / side * 2.0 - 1.0;
        const double dx = lamp[0] - x, dy = lamp[1] - y, dz = lamp[2];
        put_direction(d.to_light, count, at, dx, dy, dz);
        put_direction(d.to_eye, count, at, eye[0], eye[1], eye[2]);
        d.intensity[at] = static_cast<float>(static_cast<double>(kIntensity) / std::sqrt(std::sqrt(dx * dx + dy * dy + dz * dz)));
    }
    return d;
}

struct Surface {
    Lobe lobe;
    float f0, diffuse;
};

Plane planes_of(const Texels& t)
{
    Plane planes;
    for (const std::vector<float>& channel : t.channel)
        planes.insert(planes.end(), channel.begin(), channel.end());
    return planes;
}

Plane lit(const Surface& s, const Plane& planes, std::size_t count, const Directions& d)
{
    Plane out = padded_plane(count);
    pick<Fns>().radiance(
        {s.lobe, count, planes.data(), d.to_light.data(), d.to_eye.data(), d.intensity.data(), s.f0, s.diffuse, out.data()});
    return out;
}

Plane halved(const Plane& from, int side) // of a square of side x side
{
    const std::size_t half = static_cast<std::size_t>(side / 2), row = static_cast<std::size_t>(side);
    Plane to = padded_plane(half * half);
    for (std::size_t y = 0; y < half; ++y)
        for (std::size_t x = 0; x < half; ++x) {
            const std::size_t at = 2 * y * row + 2 * x;
            to[y * half + x] = 0.25f * (from[at] + from[at + 1] + from[at + row] + from[at + row + 1]);
        }
    return to;
}

Plane shown(const Plane& radiance)
{
    Plane to(radiance.size());
    pick<Fns>().toned(radiance.size(), radiance.data(), to.data());
    return to;
}

Image picture(const Plane& radiance, int side)
{
    Image image = make_image(side, side, 3, PixelType::f32);
    float* to = image.f32();
    for (std::size_t i = 0; i < static_cast<std::size_t>(side) * static_cast<std::size_t>(side); ++i)
        for (int c = 0; c < 3; ++c)
            *to++ = radiance[i] / (1.0f + radiance[i]);
    return image;
}

Surface surface_of(Lobe lobe, bool metal)
{
    return metal ? Surface{lobe, 0.85f, 0.0f} : Surface{lobe, 0.04f, 0.5f};
}

struct Filter {
    std::string name;
    std::vector<Texels> levels;
};

std::vector<Filter> filters_of(const Texels& level0, Lobe lobe, bool metal, const std::vector<Weights>& cascades, const Jobs& jobs)
{
    std::vector<Filter> filters = {{"baseline", classical_pyramid(level0, Method::baseline)},
                                   {"kappa .25", classical_pyramid(level0, Method::kappa, 0.25)},
                                   {"kappa .5", classical_pyramid(level0, Method::kappa, 0.5)},
                                   {"kappa 1", classical_pyramid(level0, Method::kappa, 1.0)}};
    if (lobe == Lobe::ggx_aniso)
        filters.push_back({"ssgt", classical_pyramid(level0, Method::ssgt)});
    if (lobe == Lobe::beckmann)
        filters.push_back({"leadr", classical_pyramid(level0, Method::leadr)});
    for (std::size_t k = 0; k < cascades.size(); ++k) {
        const std::string name = cascades.size() == 1 ? "mipnet" : fmt::format("mipnet {}", k + 1);
        filters.push_back({name, net_pyramid(level0, cascades[k], jobs)});
        const std::size_t side = static_cast<std::size_t>(level0.width);
        const Texels sample = sample_of(level0.width, level0.height, [&](int x, int y, float* to) {
            for (std::size_t c = 0; c < kChannels; ++c)
                to[c] = level0.channel[c][static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)];
        });
        const double kappa = static_cast<double>(kUsualMipKappa);
        const Comparison on = compare_on(sample, cascades[k], kappa, metal, jobs);
        const Method closed = on.prefers_kappa() ? Method::kappa : Method::baseline;
        filters.push_back({name + " auto", on.keeps_net() ? filters.back().levels : classical_pyramid(level0, closed, kappa)});
    }
    return filters;
}

struct Pairs { // of directions, `times` tiles^2 from the first on
    int first, times, tiles;
};

// Of each filter's pyramid, means over pairs; FLIP is left 0, and so is what is meant over levels.
using LevelFigures = std::array<Figures, kJudgedLevels + 1>;
std::vector<LevelFigures> judge_pairs(const Surface& s, const std::vector<const std::vector<Texels>*>& filters, const Pairs& pairs)
{
    std::vector<LevelFigures> rows(filters.size());
    const Texels& level0 = filters[0]->front();
    const Plane planes0 = planes_of(level0);
    std::vector<std::vector<Plane>> planes; // by filter and level
    for (const std::vector<Texels>* levels : filters) {
        planes.emplace_back();
        for (std::size_t k = 0; k <= kJudgedLevels; ++k)
            planes.back().push_back(k == 0 ? Plane() : planes_of((*levels)[k]));
    }
    for (int time = 0; time < pairs.times; ++time) {
        const int p = pairs.first + time * pairs.tiles * pairs.tiles;
        Plane truth = lit(s, planes0, level0.count(), pair_of(p, level0.width, pairs.tiles));
        for (int k = 1; k <= kJudgedLevels; ++k) {
            const int side = level0.width >> k;
            const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
            truth = halved(truth, 2 * side);
            const Plane wanted = shown(truth);
            const Directions d = pair_of(p, side, pairs.tiles);
            for (std::size_t f = 0; f < filters.size(); ++f) {
                const Plane found = shown(lit(s, planes[f][static_cast<std::size_t>(k)], count, d));
                double l1 = 0.0, mse = 0.0;
                for (std::size_t i = 0; i < count; ++i) {
                    const double e = static_cast<double>(found[i]) - static_cast<double>(wanted[i]);
                    l1 += std::fabs(e), mse += e * e;
                }
                Figures& to = rows[f][static_cast<std::size_t>(k)];
                to.l1 += l1 / static_cast<double>(count) / pairs.times;
                to.mse += mse / static_cast<double>(count) / pairs.times;
            }
        }
    }
    return rows;
}

void judge_pictures(const Surface& s, const std::vector<Filter>& filters, std::vector<Judged>& rows, const Jobs& jobs)
{
    const Texels& level0 = filters[0].levels[0];
    for (int setup = 0; setup < kSetups; ++setup) {
        Plane truth = lit(s, planes_of(level0), level0.count(), setup_of(setup, level0.width));
        for (int k = 1; k <= kJudgedLevels; ++k) {
            const int side = level0.width >> k;
            truth = halved(truth, 2 * side);
            if (side < kLeastFlipSide)
                break;
            const Image wanted = picture(truth, side);
            const Directions d = setup_of(setup, side);
            for (std::size_t f = 0; f < filters.size(); ++f) {
                const Texels& level = filters[f].levels[static_cast<std::size_t>(k)];
                const Image error = flip_ldr(wanted, picture(lit(s, planes_of(level), level.count(), d), side), {}, jobs).error;
                double sum = 0.0;
                for (std::size_t i = 0; i < level.count(); ++i)
                    sum += static_cast<double>(error.f32()[i]);
                rows[f].level[k].flip += sum / static_cast<double>(level.count()) / kSetups;
            }
        }
    }
}

} // namespace

std::vector<double> mean_l1(const std::vector<std::vector<Texels>>& pyramids, Lobe lobe, bool metal)
{
    std::vector<const std::vector<Texels>*> each;
    for (const std::vector<Texels>& levels : pyramids)
        each.push_back(&levels);
    std::vector<double> means;
    for (const LevelFigures& figures :
         judge_pairs(surface_of(lobe, metal), each, {kPairs, kTileTimes, each.front()->front().width / kTileSide})) {
        means.push_back(0.0);
        for (std::size_t k = 1; k <= kJudgedLevels; ++k)
            means.back() += figures[k].l1 / kJudgedLevels;
    }
    return means;
}

std::vector<Judged> judge(const std::vector<TestMaterial>& set, Lobe lobe, const std::vector<Weights>& cascades, const Jobs& jobs)
{
    std::vector<Judged> all;
    for (const TestMaterial& m : set) {
        const int side = m.material.texels.width;
        BN_CHECK(side == m.material.texels.height && side % (1 << kJudgedLevels) == 0);
        const Surface surface = surface_of(lobe, m.material.metal);
        const std::vector<Filter> filters = filters_of(m.material.texels, lobe, m.material.metal, cascades, jobs);
        std::vector<Judged> rows;
        std::vector<const std::vector<Texels>*> pyramids;
        for (const Filter& f : filters) {
            rows.push_back({m.set, m.material.name, f.name, {}});
            pyramids.push_back(&f.levels);
        }
        const std::vector<LevelFigures> figures = judge_pairs(surface, pyramids, {0, kPairs, 1});
        for (std::size_t f = 0; f < rows.size(); ++f)
            std::copy(figures[f].begin(), figures[f].end(), rows[f].level);
        judge_pictures(surface, filters, rows, jobs);
        for (Judged& row : rows) {
            int pictures = 0;
            for (int k = 1; k <= kJudgedLevels; ++k) {
                row.level[0].l1 += row.level[k].l1 / kJudgedLevels, row.level[0].mse += row.level[k].mse / kJudgedLevels;
                if (side >> k >= kLeastFlipSide)
                    row.level[0].flip += row.level[k].flip, ++pictures;
            }
            row.level[0].flip /= std::max(pictures, 1);
            all.push_back(row);
        }
    }
    return all;
}

std::vector<Summary> summaries(const std::vector<Judged>& rows)
{
    std::vector<Summary> all;
    const Judged* base = nullptr; // of the same material: it comes first
    for (const Judged& row : rows) {
        if (row.filter == "baseline")
            base = &row;
        auto s = std::find_if(all.begin(), all.end(), [&](const Summary& a) { return a.set == row.set && a.filter == row.filter; });
        if (s == all.end()) {
            s = all.emplace(all.end());
            s->set = row.set, s->filter = row.filter;
        }
        const Figures &f = row.level[0], &b = base->level[0];
        ++s->materials;
        s->mean.flip += f.flip, s->mean.l1 += f.l1, s->mean.mse += f.mse, s->first_level_l1 += row.level[1].l1;
        s->wins[0] += f.flip < b.flip, s->wins[1] += f.l1 < b.l1, s->wins[2] += f.mse < b.mse;
        s->worst_l1 = std::max(s->worst_l1, f.l1 / b.l1);
    }
    for (Summary& s : all) {
        const double n = static_cast<double>(s.materials);
        s.mean.flip /= n, s.mean.l1 /= n, s.mean.mse /= n, s.first_level_l1 /= n;
        for (double& w : s.wins)
            w /= n;
    }
    std::stable_sort(all.begin(), all.end(), [](const Summary& a, const Summary& b) { return a.set < b.set; });
    return all;
}

} // namespace burnish::mipnet
