// Heat maps over roughness and anisotropy.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <optional>

#include "apps/chart/plots.h"
#include "apps/report/axes.h"
#include "core/image/magma.h"

namespace burnish {
namespace {

constexpr const char* kComparedWith = "bent_normal";
constexpr double kLetter = 8.0; // px of a letter in the widest names

// Maps errors from 0 to `most` to FLIP's own colours.
Paint sequential(double value, double most)
{
    Image one = make_image(1, 1, 1, PixelType::f32);
    one.f32()[0] = static_cast<float>(0.95 * std::clamp(value / most, 0.0, 1.0)); // the last colours are too pale on paper
    const Image mapped = magma_map(one);
    const auto channel = [&mapped](std::size_t i) { return static_cast<double>(mapped.bytes[i]); };
    return {channel(0), channel(1), channel(2)};
}

// Maps less error than the baseline to blue, more to orange. Red-green colour blindness does not hide the difference.
Paint diverging(double value, double most)
{
    constexpr std::array<int, 3> kLess = {0, 90, 160}, kNone = {245, 245, 245}, kMore = {190, 80, 0};
    const double t = std::clamp(std::abs(value) / most, 0.0, 1.0);
    const std::array<int, 3>& end = value < 0.0 ? kLess : kMore;
    const auto mix = [&](std::size_t i) { return std::floor(kNone[i] + t * (end[i] - kNone[i]) + 0.5); };
    return {mix(0), mix(1), mix(2)};
}

const char* ink_on(const Paint& c)
{
    return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] > 140.0 ? "on-pale" : "on-dark";
}

// Returns the row that represents a technique in a cell.
const ChartRow* row_of(const RowList& rows, const std::string& technique, const Cell& cell)
{
    std::vector<int> samples;
    for (const ChartRow* row : rows)
        if (row->setting.technique == technique && row->cell == cell)
            samples.push_back(row->setting.samples);
    if (samples.empty())
        return nullptr;
    const int wanted = representative_samples(technique, samples);
    for (const ChartRow* row : rows)
        if (row->setting.technique == technique && row->cell == cell && row->setting.samples == wanted)
            return row;
    return nullptr;
}

std::optional<double> value_of(const RowList& rows, const ChartRow& row, bool difference)
{
    double value = flip_of(row);
    if (difference) {
        const ChartRow* baseline = row_of(rows, kComparedWith, row.cell);
        if (!baseline)
            return std::nullopt;
        value -= flip_of(*baseline);
    }
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::optional<float>> values_of(const RowList& rows, std::optional<float> Cell::*of)
{
    std::vector<std::optional<float>> values;
    for (const ChartRow* row : rows)
        if (std::find(values.begin(), values.end(), row->cell.*of) == values.end())
            values.push_back(row->cell.*of);
    std::sort(values.begin(), values.end());
    return values;
}

// Returns one scale for all techniques, so that their maps can be compared.
double largest(const RowList& rows, bool difference)
{
    double most = 1e-6;
    for (const ChartRow* row : rows)
        if (const ChartRow* shown = row_of(rows, row->setting.technique, row->cell); shown == row)
            if (const std::optional<double> value = value_of(rows, *row, difference))
                most = std::max(most, std::abs(*value));
    return most;
}

struct Map {
    const RowList& rows;
    std::string technique;
    bool difference;
    double most, left, top, cell_w, cell_h;
};

Paint colour_of(const Map& map, double value)
{
    return map.difference ? diverging(value, map.most) : sequential(value, map.most);
}

void draw_cell(Drawing& out, const Map& map, const Cell& cell, double x, double y)
{
    const ChartRow* row = row_of(map.rows, map.technique, cell);
    const std::optional<double> value = row ? value_of(map.rows, *row, map.difference) : std::nullopt;
    if (!value) {
        out.text(x + map.cell_w / 2.0, y + map.cell_h / 2.0 + 4.0, "tick middle", "none");
        return;
    }
    const Paint colour = colour_of(map, *value);
    out.open("point cell",
             {{"role", "img"},
              {"aria-label", fmt::format("{}; {}{}", describe(cell), describe(*row),
                                         map.difference ? fmt::format(", {} more than {}", number(*value), kComparedWith) : "")},
              {"data-row", row->key}},
             describe(*row));
    out.rectangle(x, y, map.cell_w - 1.0, map.cell_h - 1.0, "mark", colour);
    if (map.cell_w >= 38.0)
        out.text(x + map.cell_w / 2.0, y + map.cell_h / 2.0 + 4.0, std::string("value middle ") + ink_on(colour),
                 map.difference ? fmt::format("{:+.3f}", *value) : fmt::format("{:.3f}", *value));
    out.close();
}

void draw_scale(Drawing& out, const Map& map, double y, double width)
{
    constexpr int kSteps = 32;
    const double step = width / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps, value = map.difference ? (2.0 * t - 1.0) * map.most : t * map.most;
        out.rectangle(map.left + i * step, y, step + 0.5, 9.0, "", colour_of(map, value));
    }
    out.text(map.left, y + 24.0, "tick", map.difference ? fmt::format("{:.3f} (better)", -map.most) : "0");
    out.text(map.left + width, y + 24.0, "tick end",
             map.difference ? fmt::format("+{:.3f} (worse)", map.most) : fmt::format("{:.3f}", map.most));
}

} // namespace

Drawing plot_heat(const RowList& rows, const std::string& technique, bool difference)
{
    const auto roughness = values_of(rows, &Cell::roughness), anisotropy = values_of(rows, &Cell::anisotropy);
    if (technique == kPlanned || roughness.size() * anisotropy.size() < 2 || (difference && technique == kComparedWith))
        return {};
    if (difference && std::none_of(rows.begin(), rows.end(), [](const ChartRow* row) { return row->setting.technique == kComparedWith; }))
        return {};
    const auto text = [](const std::optional<float>& v) { return v ? fmt::format("{:g}", *v) : std::string("scene's"); };
    const std::string title = difference ? technique + " - " + kComparedWith : technique;
    const double columns = static_cast<double>(anisotropy.size()), lines = static_cast<double>(roughness.size());
    const Map map{rows, technique, difference, largest(rows, difference), 62.0, 30.0, std::clamp(300.0 / columns, 12.0, 64.0), 28.0};
    const double bottom = map.top + map.cell_h * lines,
                 width = std::max({columns * map.cell_w, 190.0, kLetter * static_cast<double>(title.size())});
    Drawing out(map.left + width + 12.0, bottom + 88.0, "chart heat",
                difference ? technique + " against " + kComparedWith + " over roughness and anisotropy"
                           : technique + " over roughness and anisotropy");
    out.text(map.left, 18.0, "name", title);
    for (std::size_t r = 0; r < roughness.size(); ++r) {
        const double y = bottom - map.cell_h * static_cast<double>(r + 1);
        out.text(map.left - 7.0, y + map.cell_h / 2.0 + 4.0, "tick end", text(roughness[r]));
        for (std::size_t a = 0; a < anisotropy.size(); ++a)
            draw_cell(out, map, {roughness[r], anisotropy[a]}, map.left + map.cell_w * static_cast<double>(a), y);
    }
    const std::size_t every = map.cell_w >= 30.0 ? 1 : static_cast<std::size_t>(std::ceil(30.0 / map.cell_w));
    for (std::size_t a = 0; a < anisotropy.size(); a += every)
        out.text(map.left + map.cell_w * (static_cast<double>(a) + 0.5), bottom + 16.0, "tick middle", text(anisotropy[a]));
    out.text(map.left + columns * map.cell_w / 2.0, bottom + 36.0, "title middle", "anisotropy");
    out.text(14.0, (map.top + bottom) / 2.0, "title middle", "roughness", -90.0);
    draw_scale(out, map, bottom + 48.0, width);
    return out;
}

} // namespace burnish
