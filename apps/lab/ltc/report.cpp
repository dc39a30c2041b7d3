#include "apps/lab/ltc/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/image/magma.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr std::size_t kProbes = 1u << 20;

using Choice = std::function<bool(const ltc::Place&)>;

LtcFigures figures_of(const char* name, const std::vector<ltc::Judged>& judged, const Choice& chosen)
{
    std::vector<double> l1, best, pairs, relative, absolute, all, grazing;
    for (const ltc::Judged& j : judged) {
        if (!chosen(j.place))
            continue;
        l1.push_back(j.l1), best.push_back(j.best_l1), pairs.push_back(j.pair_l1), all.push_back(j.all_relative),
            grazing.push_back(j.grazing_absolute);
        relative.insert(relative.end(), j.light_relative, j.light_relative + ltc::kLights);
        absolute.insert(absolute.end(), j.light_absolute, j.light_absolute + ltc::kLights);
    }
    return {name,
            l1.size(),
            ltc::spread_of(l1),
            ltc::spread_of(best),
            ltc::spread_of(pairs),
            ltc::spread_of(relative),
            ltc::spread_of(absolute),
            ltc::spread_of(all),
            ltc::spread_of(grazing)};
}

LtcSampling sampling_of(const char* name, const std::vector<ltc::Sampled>& all, const Choice& chosen)
{
    std::vector<double> unseen, furnace[2], deviation[ltc::kSamplers];
    for (const ltc::Sampled& s : all) {
        if (!chosen(s.place))
            continue;
        unseen.push_back(s.unseen);
        for (int i = 0; i < 2; ++i)
            furnace[i].push_back(s.furnace[i]);
        for (int i = 0; i < ltc::kLights; ++i)
            for (int by = 0; by < ltc::kSamplers; ++by)
                if (s.lights[by][i] >= 0.0)
                    deviation[by].push_back(s.lights[by][i]);
    }
    LtcSampling r = {name, deviation[0].size(), ltc::spread_of(unseen), {}, {}};
    for (int i = 0; i < 2; ++i)
        r.furnace[i] = ltc::spread_of(furnace[i]);
    for (int by = 0; by < ltc::kSamplers; ++by)
        r.deviation[by] = ltc::spread_of(deviation[by]);
    return r;
}

Json json_of(const ltc::Spread& s)
{
    return {{"mean", s.mean}, {"median", s.median}, {"p95", s.p95}, {"max", s.most}};
}

constexpr const char* kAxes[4] = {"theta, degrees", "phi, degrees", "alpha", "lambda"};

std::string tick(const ltc::Grid& grid, int axis, int node)
{
    const double u = static_cast<double>(node) / (grid.size - 1);
    return fmt::format("{:.2g}", axis < 2 ? 90.0 * u : axis == 2 ? grid.alpha_at(node) : u);
}

std::vector<Paint> colours(const std::vector<double>& values, double most)
{
    Image image = make_image(static_cast<int>(values.size()), 1, 1, PixelType::f32);
    for (std::size_t i = 0; i < values.size(); ++i)
        image.f32()[i] = static_cast<float>(0.95 * std::clamp(values[i] / most, 0.0, 1.0)); // the last colours are too pale on paper
    const Image mapped = magma_map(image);
    std::vector<Paint> paints;
    for (std::size_t i = 0; i < values.size(); ++i)
        paints.push_back({static_cast<double>(mapped.bytes[3 * i]), static_cast<double>(mapped.bytes[3 * i + 1]),
                          static_cast<double>(mapped.bytes[3 * i + 2])});
    return paints;
}

struct Means { // over the other two axes, rows from the top
    int columns, rows;
    std::vector<double> values;
};

Means means(const LtcQuality& quality, int across, int up)
{
    const std::array<int, 4> n = quality.grid.sizes();
    const auto cells = [&n](int axis) { return n[static_cast<std::size_t>(axis)] - 1; };
    Means m = {cells(across), cells(up), {}};
    m.values.assign(static_cast<std::size_t>(m.columns) * static_cast<std::size_t>(m.rows), 0.0);
    const double share = static_cast<double>(m.values.size()) / static_cast<double>(quality.l1_of_cells.size());
    const std::vector<std::array<int, 4>> all = quality.grid.cells();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const int column = all[i][static_cast<std::size_t>(across)], row = m.rows - 1 - all[i][static_cast<std::size_t>(up)];
        m.values[static_cast<std::size_t>(row * m.columns + column)] += quality.l1_of_cells[i] * share;
    }
    return m;
}

constexpr double kSide = 252.0, kLeft = 66.0, kBelow = 52.0, kTop = 40.0;

void draw_map(Drawing& out, const LtcQuality& quality, int across, int up, double x, double y, double most)
{
    const Means m = means(quality, across, up);
    const double wide = kSide / m.columns, high = kSide / m.rows;
    const std::vector<Paint> paints = colours(m.values, most);
    for (int row = 0; row < m.rows; ++row)
        for (int column = 0; column < m.columns; ++column) {
            const std::size_t i = static_cast<std::size_t>(row * m.columns + column);
            const Paint& c = paints[i];
            out.rectangle(x + wide * column, y + high * row, wide - 1.0, high - 1.0, "mark", c);
            const bool pale = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] > 140.0;
            if (wide >= 24.0 && high >= 20.0)
                out.text(x + wide * (column + 0.5), y + high * (row + 0.5) + 4.0, pale ? "value middle on-pale" : "value middle on-dark",
                         fmt::format("{:.2f}", m.values[i]));
        }
    for (int node = 0; node <= m.columns; ++node)
        out.text(x + wide * node, y + kSide + 15.0, "tick middle", tick(quality.grid, across, node));
    for (int node = 0; node <= m.rows; ++node)
        out.text(x - 6.0, y + kSide - high * node + 4.0, "tick end", tick(quality.grid, up, node));
    out.text(x + kSide / 2.0, y + kSide + 33.0, "title middle", kAxes[across]);
    out.text(x - 48.0, y + kSide / 2.0, "title middle", kAxes[up], -90.0);
}

// Figures measured for the authors' own table (KT et al. 2022), on other lobe lists with equal size and distribution. best: the part's
// lower bound. NaN: unknown.
struct PublishedFigures {
    const char* part;
    double l1, p95, most, best, light, light_p95, absolute, all_relative;
};
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr PublishedFigures kPublished[] = {
    {"all", 0.1466, 0.442, 0.784, 0.1255, 0.0723, 0.289, 0.0078, 0.006},
    {"theta > 70", 0.3189, 0.685, 0.784, 0.246, 0.2007, 0.481, 0.0235, kUnknown},
    {"alpha < 1/7", 0.1330, 0.467, 0.784, 0.069, 0.0589, 0.290, 0.0130, kUnknown},
    {"lambda < .3", 0.2500, 0.537, 0.761, kUnknown, 0.0992, 0.372, kUnknown, kUnknown},
    {"others", 0.1673, 0.507, 1.29, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown},
};

const PublishedFigures* published_of(const std::string& part)
{
    for (const PublishedFigures& p : kPublished)
        if (p.part == part)
            return &p;
    return nullptr;
}

std::string column(double value)
{
    return std::isnan(value) ? fmt::format("{:>7}", "") : fmt::format("{:7.4f}", value);
}

Json known(double value)
{
    return std::isnan(value) ? Json() : Json(value);
}

Json json_of(const PublishedFigures& p)
{
    return {{"l1", {{"mean", known(p.l1)}, {"p95", known(p.p95)}, {"max", known(p.most)}}},
            {"best_l1", {{"mean", known(p.best)}}},
            {"light_relative", {{"mean", known(p.light)}, {"p95", known(p.light_p95)}}},
            {"light_absolute", {{"mean", known(p.absolute)}}},
            {"nd_relative", {{"mean", known(p.all_relative)}}}};
}

} // namespace

LtcQuality measure_ltc(const ltc::Table& table, int cosines, const Jobs& jobs)
{
    const auto all = [](const ltc::Place&) { return true; };
    const std::vector<ltc::Judged> first = ltc::judge(table, ltc::judged_places(200, 24, 0), cosines, jobs);
    const std::vector<ltc::Judged> others = ltc::judge(table, ltc::judged_places(600, 0, 1000), cosines, jobs);
    LtcQuality q;
    q.cosines = cosines, q.model = table.model();
    q.parts.push_back(figures_of("all", first, all));
    q.parts.push_back(figures_of("theta > 70", first, [](const ltc::Place& p) { return p.theta > 70.0 / 180.0 * kPi; }));
    q.parts.push_back(figures_of("alpha < 1/7", first, [](const ltc::Place& p) { return p.alpha < 1.0 / 7.0; }));
    q.parts.push_back(figures_of("lambda < .3", first, [](const ltc::Place& p) { return p.lambda < 0.3; }));
    q.parts.push_back(figures_of("others", others, all));
    q.parts.push_back(figures_of("theta 75-89", ltc::judge(table, ltc::grazing_places(200), cosines, jobs), all));
    const std::vector<ltc::Sampled> samples = ltc::judge_sampling(table, ltc::judged_places(200, 24, 0), jobs);
    q.sampling.push_back(sampling_of("all", samples, all));
    q.sampling.push_back(sampling_of("theta > 70", samples, [](const ltc::Place& p) { return p.theta > 70.0 / 180.0 * kPi; }));
    q.sampling.push_back(sampling_of("lambda < .3", samples, [](const ltc::Place& p) { return p.lambda < 0.3; }));
    q.probes = kProbes, q.broken = ltc::broken_lookups(table, kProbes, jobs);
    q.grid = table.grid.round ? ltc::Grid() : table.grid, q.l1_of_cells = ltc::l1_of_cells(table, jobs);
    return q;
}

std::string ltc_lines(const LtcQuality& quality)
{
    std::string text = fmt::format("{:<12} {:>5}  {:>7} {:>7} {:>7} {:>7}  {:>7} {:>7} {:>7}  {:>7} {:>7}\n", "lobes", "", "L1", "p95",
                                   "max", "best", "light", "p95", "abs", "nD", "fD");
    for (const LtcFigures& f : quality.parts) {
        text += fmt::format("{:<12} {:>5}  {:7.4f} {:7.4f} {:7.4f} {:7.4f}  {:7.4f} {:7.4f} {:7.4f}  {:7.4f} {:7.4f}\n", f.name, f.lobes,
                            f.l1.mean, f.l1.p95, f.l1.most, f.best_l1.mean, f.light_relative.mean, f.light_relative.p95,
                            f.light_absolute.mean, f.all_relative.mean, f.grazing_absolute.mean);
        if (const PublishedFigures* p = quality.model == ltc::Model::ggx ? published_of(f.name) : nullptr)
            text += fmt::format("{:<18}  {} {} {} {}  {} {} {}  {}\n", "  published", column(p->l1), column(p->p95), column(p->most),
                                column(p->best), column(p->light), column(p->light_p95), column(p->absolute), column(p->all_relative));
    }
    if (quality.cosines == 2)
        for (const LtcFigures& f : quality.parts)
            text += fmt::format("{:<12} {:>5}  {:7.4f} {:7.4f} {:7.4f}  with the nearest sum of two where one is {:g} off\n", f.name,
                                f.lobes, f.with_pairs.mean, f.with_pairs.p95, f.with_pairs.most, ltc::kFarOff);
    text += fmt::format("{:<12} {} of {}\n", "det <= 0", quality.broken, quality.probes);
    text += fmt::format("{:<12} {:>5}  {:>23}  {:>23}  {:>23}\n{:<12} {:>5}  {:>7} {:>7} {:>7}  {:>7} {:>7} {:>7}  {:>7} {:>7}\n",
                        "deviation of a", "", "quads by", "p95 by", "even light by", "sample", "quads", "cosine", "normals", "area",
                        "cosine", "normals", "area", "cosine", "normals");
    for (const LtcSampling& s : quality.sampling)
        text +=
            fmt::format("{:<12} {:>5}  {:7.3f} {:7.3f} {:7.3f}  {:7.3f} {:7.3f} {:7.3f}  {:7.3f} {:7.3f}   {:.2f} % unseen by cosines\n",
                        s.name, s.lights, s.deviation[0].mean, s.deviation[1].mean, s.deviation[2].mean, s.deviation[0].p95,
                        s.deviation[1].p95, s.deviation[2].p95, s.furnace[0].mean, s.furnace[1].mean, 100.0 * s.unseen.mean);
    return text;
}

Json ltc_json(const LtcQuality& quality, const ltc::Table& table)
{
    constexpr const char* kNorms[] = {"l1", "l3", "sw"};
    constexpr const char* kBases[] = {"tangent", "mirror", "natural"};
    Json parts = Json::array();
    for (const LtcFigures& f : quality.parts) {
        Json part = {{"lobes", f.name},
                     {"count", f.lobes},
                     {"l1", json_of(f.l1)},
                     {"best_l1", json_of(f.best_l1)},
                     {"light_relative", json_of(f.light_relative)},
                     {"light_absolute", json_of(f.light_absolute)},
                     {"nd_relative", json_of(f.all_relative)},
                     {"fd_absolute", json_of(f.grazing_absolute)}};
        if (quality.cosines == 2)
            part["with_pairs_l1"] = json_of(f.with_pairs);
        if (const PublishedFigures* p = quality.model == ltc::Model::ggx ? published_of(f.name) : nullptr)
            part["published"] = json_of(*p);
        parts.push_back(std::move(part));
    }
    Json sampling = Json::array();
    for (const LtcSampling& s : quality.sampling)
        sampling.push_back({{"lobes", s.name},
                            {"quads", s.lights},
                            {"unseen", json_of(s.unseen)},
                            {"even_light", {{"cosine", json_of(s.furnace[0])}, {"visible_normals", json_of(s.furnace[1])}}},
                            {"deviation",
                             {{"cosine", json_of(s.deviation[ltc::kByCosine])},
                              {"visible_normals", json_of(s.deviation[ltc::kByVisibleNormals])},
                              {"area", json_of(s.deviation[ltc::kByArea])}}}});
    return {{"table",
             {{"size", table.grid.size},
              {"alpha_nodes", table.grid.root_alpha ? "squares" : "even"},
              {"most_alpha", table.grid.most_alpha()},
              {"round", table.grid.round},
              {"brdf", ltc::kModelNames[static_cast<int>(table.model())]},
              {"fit", kNorms[(table.made & ltc::kNormMask) >> ltc::kNormShift]},
              {"aligned", (table.made & ltc::kUnaligned) == 0},
              {"symmetric", (table.made & ltc::kUnsymmetric) == 0},
              {"held", table.grid.inverse      ? "inverse"
                       : table.grid.over_alpha ? "over alpha"
                                               : "matrix"},
              {"basis", kBases[static_cast<int>(table.grid.basis)]}}},
            {"parts", parts},
            {"sampling", sampling},
            {"lookups", {{"probed", quality.probes}, {"broken", quality.broken}}},
            {"l1_of_cells", Json(quality.l1_of_cells)}};
}

Drawing plot_ltc_quality(const LtcQuality& quality)
{
    constexpr std::pair<int, int> kPairs[] = {{0, 2}, {0, 3}, {2, 3}, {1, 0}, {1, 2}, {1, 3}}; // across, up
    double most = 1e-6;
    for (const auto& [across, up] : kPairs)
        for (double v : means(quality, across, up).values)
            most = std::max(most, v);
    const double step_x = kLeft + kSide + 14.0, step_y = kSide + kBelow;
    Drawing out(3.0 * step_x + 10.0, kTop + 2.0 * step_y + 8.0, "chart", "L1 distance of transformed cosines from their lobes");
    out.text(kLeft, 22.0, "name", "L1 in the middle of cells, mean over the other two axes");
    for (int i = 0; i < 6; ++i)
        draw_map(out, quality, kPairs[i].first, kPairs[i].second, kLeft + step_x * (i % 3), kTop + step_y * (i / 3), most);
    return out;
}

} // namespace burnish
