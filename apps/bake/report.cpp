#include "apps/bake/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <functional>

#include "core/image/magma.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr std::size_t kProbes = 1u << 20;

using Choice = std::function<bool(const ltc::Place&)>;

LtcFigures figures_of(const char* name, const std::vector<ltc::Judged>& judged, const Choice& chosen)
{
    std::vector<double> l1, best, relative, absolute, all, grazing;
    for (const ltc::Judged& j : judged) {
        if (!chosen(j.place))
            continue;
        l1.push_back(j.l1), best.push_back(j.best_l1), all.push_back(j.all_relative), grazing.push_back(j.grazing_absolute);
        relative.insert(relative.end(), j.light_relative, j.light_relative + ltc::kLights);
        absolute.insert(absolute.end(), j.light_absolute, j.light_absolute + ltc::kLights);
    }
    return {name,
            l1.size(),
            ltc::spread_of(l1),
            ltc::spread_of(best),
            ltc::spread_of(relative),
            ltc::spread_of(absolute),
            ltc::spread_of(all),
            ltc::spread_of(grazing)};
}

Json json_of(const ltc::Spread& s)
{
    return {{"mean", s.mean}, {"median", s.median}, {"p95", s.p95}, {"max", s.most}};
}

struct AxisOfTable {
    const char* name;
    double most; // at the last node, in what is written beside the axis
    bool rooted; // nodes lie at squares where the table says so
};
constexpr AxisOfTable kAxes[4] = {
    {"theta, degrees", 90.0, false}, {"phi, degrees", 90.0, false}, {"alpha", 1.0, true}, {"lambda", 1.0, false}};

std::string tick(const AxisOfTable& axis, int node, int cells, bool root_alpha)
{
    const double u = static_cast<double>(node) / cells;
    return fmt::format("{:.2g}", axis.most * (axis.rooted && root_alpha ? u * u : u));
}

std::vector<Paint> colours(const std::vector<double>& values, double most)
{
    Image image = make_image(static_cast<int>(values.size()), 1, 1, PixelType::f32);
    for (std::size_t i = 0; i < values.size(); ++i)
        image.f32()[i] = static_cast<float>(0.95 * std::clamp(values[i] / most, 0.0, 1.0)); // the last tints are too pale on paper
    const Image mapped = magma_map(image);
    std::vector<Paint> paints;
    for (std::size_t i = 0; i < values.size(); ++i)
        paints.push_back({static_cast<double>(mapped.bytes[3 * i]), static_cast<double>(mapped.bytes[3 * i + 1]),
                          static_cast<double>(mapped.bytes[3 * i + 2])});
    return paints;
}

// Means over the other two axes, rows from the top.
std::vector<double> means(const LtcQuality& quality, int across, int up)
{
    const int n = quality.cells;
    std::vector<double> sum(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
    for (std::size_t i = 0; i < quality.l1_of_cells.size(); ++i) {
        const int at = static_cast<int>(i), index[4] = {at / (n * n * n), at / (n * n) % n, at / n % n, at % n};
        sum[static_cast<std::size_t>((n - 1 - index[up]) * n + index[across])] += quality.l1_of_cells[i] / (n * n);
    }
    return sum;
}

constexpr double kSide = 252.0, kLeft = 66.0, kBelow = 52.0, kTop = 40.0;

void draw_map(Drawing& out, const LtcQuality& quality, bool root_alpha, int across, int up, double x, double y, double most)
{
    const int n = quality.cells;
    const double cell = kSide / n;
    const std::vector<double> values = means(quality, across, up);
    const std::vector<Paint> paints = colours(values, most);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const std::size_t i = static_cast<std::size_t>(row * n + column);
            const Paint& c = paints[i];
            out.rectangle(x + cell * column, y + cell * row, cell - 1.0, cell - 1.0, "mark", c);
            const bool pale = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] > 140.0;
            if (cell >= 32.0)
                out.text(x + cell * (column + 0.5), y + cell * (row + 0.5) + 4.0, pale ? "value middle on-pale" : "value middle on-dark",
                         fmt::format("{:.2f}", values[i]));
        }
    for (int node = 0; node <= n; ++node) {
        out.text(x + cell * node, y + kSide + 15.0, "tick middle", tick(kAxes[across], node, n, root_alpha));
        out.text(x - 6.0, y + kSide - cell * node + 4.0, "tick end", tick(kAxes[up], node, n, root_alpha));
    }
    out.text(x + kSide / 2.0, y + kSide + 33.0, "title middle", kAxes[across].name);
    out.text(x - 48.0, y + kSide / 2.0, "title middle", kAxes[up].name, -90.0);
}

} // namespace

LtcQuality measure_ltc(const ltc::Table& table, const Jobs& jobs)
{
    const auto all = [](const ltc::Place&) { return true; };
    const std::vector<ltc::Judged> first = ltc::judge(table, ltc::judged_places(200, 24, 0), true, jobs);
    const std::vector<ltc::Judged> others = ltc::judge(table, ltc::judged_places(600, 0, 1000), true, jobs);
    LtcQuality q;
    q.parts.push_back(figures_of("all", first, all));
    q.parts.push_back(figures_of("theta > 70", first, [](const ltc::Place& p) { return p.theta > 70.0 / 180.0 * kPi; }));
    q.parts.push_back(figures_of("alpha < 1/7", first, [](const ltc::Place& p) { return p.alpha < 1.0 / 7.0; }));
    q.parts.push_back(figures_of("lambda < .3", first, [](const ltc::Place& p) { return p.lambda < 0.3; }));
    q.parts.push_back(figures_of("others", others, all));
    q.probes = kProbes, q.broken = ltc::broken_lookups(table, kProbes, jobs);
    q.cells = table.grid.size - 1, q.l1_of_cells = ltc::l1_of_cells(table, jobs);
    return q;
}

std::string ltc_lines(const LtcQuality& quality)
{
    std::string text = fmt::format("{:<12} {:>5}  {:>7} {:>7} {:>7} {:>7}  {:>7} {:>7} {:>7}  {:>7} {:>7}\n", "lobes", "", "L1", "p95",
                                   "max", "best", "light", "p95", "abs", "nD", "fD");
    for (const LtcFigures& f : quality.parts)
        text += fmt::format("{:<12} {:>5}  {:7.4f} {:7.4f} {:7.4f} {:7.4f}  {:7.4f} {:7.4f} {:7.4f}  {:7.4f} {:7.4f}\n", f.name, f.lobes,
                            f.l1.mean, f.l1.p95, f.l1.most, f.best_l1.mean, f.light_relative.mean, f.light_relative.p95,
                            f.light_absolute.mean, f.all_relative.mean, f.grazing_absolute.mean);
    return text + fmt::format("{:<12} {} of {}\n", "det <= 0", quality.broken, quality.probes);
}

Json ltc_json(const LtcQuality& quality, const ltc::Table& table)
{
    constexpr const char* kBases[] = {"tangent", "mirror", "natural"};
    Json parts = Json::array();
    for (const LtcFigures& f : quality.parts)
        parts.push_back({{"lobes", f.name},
                         {"count", f.lobes},
                         {"l1", json_of(f.l1)},
                         {"best_l1", json_of(f.best_l1)},
                         {"light_relative", json_of(f.light_relative)},
                         {"light_absolute", json_of(f.light_absolute)},
                         {"nd_relative", json_of(f.all_relative)},
                         {"fd_absolute", json_of(f.grazing_absolute)}});
    return {{"table",
             {{"size", table.grid.size},
              {"alpha_nodes", table.grid.root_alpha ? "squares" : "even"},
              {"basis", kBases[static_cast<int>(table.grid.basis)]}}},
            {"parts", parts},
            {"lookups", {{"probed", quality.probes}, {"broken", quality.broken}}},
            {"l1_of_cells", Json(quality.l1_of_cells)}};
}

Drawing plot_ltc_quality(const LtcQuality& quality, const ltc::Table& table)
{
    constexpr std::pair<int, int> kPairs[] = {{0, 2}, {0, 3}, {2, 3}, {1, 0}, {1, 2}, {1, 3}}; // across, up
    double most = 1e-6;
    for (const auto& [across, up] : kPairs)
        for (double v : means(quality, across, up))
            most = std::max(most, v);
    const double step_x = kLeft + kSide + 14.0, step_y = kSide + kBelow;
    Drawing out(3.0 * step_x + 10.0, kTop + 2.0 * step_y + 8.0, "chart", "L1 distance of transformed cosines from their lobes");
    out.text(kLeft, 22.0, "name", "L1 in the middle of cells, mean over the other two axes");
    for (int i = 0; i < 6; ++i)
        draw_map(out, quality, table.grid.root_alpha, kPairs[i].first, kPairs[i].second, kLeft + step_x * (i % 3), kTop + step_y * (i / 3),
                 most);
    return out;
}

} // namespace burnish
