#include "apps/chart/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/chart/plots.h"
#include "apps/render/stats.h"
#include "apps/report/assets.h"
#include "apps/report/axes.h"
#include "apps/report/chart_style.h"
#include "apps/report/html.h"
#include "apps/report/json.h"
#include "apps/report/pictures.h"
#include "apps/report/svg.h"

namespace burnish {
namespace {

struct PlaceRows { // one scene, environment and cell
    Cell cell;
    RowList rows;
    const ChartReference* reference;
};

struct PairRows { // one scene and environment
    std::string scene, env;
    RowList rows;
    std::vector<PlaceRows> places;
};

std::vector<PairRows> group(const ChartReport& report)
{
    std::vector<PairRows> pairs;
    for (const ChartRow& row : report.rows) {
        if (pairs.empty() || pairs.back().scene != row.scene || pairs.back().env != row.env)
            pairs.push_back({row.scene, row.env, {}, {}});
        PairRows& pair = pairs.back();
        if (pair.places.empty() || pair.places.back().cell != row.cell)
            pair.places.push_back({row.cell, {}, &report.references.at(place(row))});
        pair.rows.push_back(&row);
        pair.places.back().rows.push_back(&row);
    }
    return pairs;
}

struct Figure {
    std::string name, caption; // name: of the file
    Drawing wide, narrow;
};

std::string sweeps_html(const RowList& rows)
{
    std::string out;
    for (const std::string& option : swept_numbers(rows)) {
        const Drawing wide = plot_sweep(rows, option, Layout::wide), narrow = plot_sweep(rows, option, Layout::narrow);
        if (!wide.empty())
            out += fmt::format("<figure><figcaption>Error by {}; of the numbers of samples, the one nearest to each technique's own; other "
                               "options as in the first place.</figcaption>\n{}{}</figure>\n",
                               escaped(option), svg_of(wide), svg_of(narrow));
    }
    return out.empty() ? out : "<div class=\"charts\">\n" + out + "</div>\n";
}

std::vector<Figure> figures_of(const RowList& rows)
{
    std::vector<Figure> figures = {
        {"time-flip",
         "Time against error: lower left is better. Filled marks are on the Pareto front: nothing else is both faster and "
         "more accurate. The thin line to the right of a mark ends at the 95th percentile of its times.",
         plot_time_flip(rows, Layout::wide), plot_time_flip(rows, Layout::narrow)},
        {"samples-flip", "Error by number of samples. Broken lines: techniques that take none.",
         plot_samples(rows, Quantity::flip, Layout::wide), plot_samples(rows, Quantity::flip, Layout::narrow)},
        {"samples-time", "Time by number of samples.", plot_samples(rows, Quantity::time, Layout::wide),
         plot_samples(rows, Quantity::time, Layout::narrow)}};
    const bool timed = !rows.front()->measured.ms.empty();
    std::erase_if(figures, [&](const Figure& f) { return f.wide.empty() || (!timed && f.name.find("time") != std::string::npos); });
    return figures;
}

std::string charts_html(const RowList& rows)
{
    std::string out = "<div class=\"charts\">\n";
    for (const Figure& figure : figures_of(rows))
        out +=
            fmt::format("<figure><figcaption>{}</figcaption>\n{}{}</figure>\n", figure.caption, svg_of(figure.wide), svg_of(figure.narrow));
    return out + "</div>\n";
}

std::string heats_html(const RowList& rows)
{
    std::string maps, differences;
    if (rows.empty() || !rows.front()->cell.others.empty()) // other options are swept too
        return "";
    for (const std::string& technique : techniques_of(rows)) {
        if (const Drawing map = plot_heat(rows, technique, false); !map.empty())
            maps += svg_of(map);
        if (const Drawing difference = plot_heat(rows, technique, true); !difference.empty())
            differences += svg_of(difference);
    }
    std::string out;
    if (!maps.empty())
        out += "<h3>Error over roughness and anisotropy</h3>\n<p>Mean FLIP, one scale for all maps; of the numbers of samples, the one "
               "nearest "
               "to the technique's own.</p>\n<div class=\"heats\">\n" +
               maps + "</div>\n";
    if (!differences.empty())
        out += "<h3>Difference to bent_normal</h3>\n<p>Mean FLIP minus that of bent_normal: blue is better, orange is worse.</p>\n"
               "<div class=\"heats\">\n" +
               differences + "</div>\n";
    return out;
}

std::string setting_text(const ChartRow& row)
{
    if (row.setting.budget > 0.0)
        return fmt::format("budget {:g}", row.setting.budget);
    return row.setting.sampled ? fmt::format("{} sample{}", row.setting.samples, row.setting.samples == 1 ? "" : "s") : "one fetch";
}

// Returns a figure of patterns; a reference without a variance gives none.
std::string known(double value)
{
    return std::isfinite(value) ? number(value) : "unknown";
}

std::string table_html(const RowList& rows)
{
    std::string out =
        "<details><summary>All figures</summary>\n<p>Pattern: noise, rows and combs of the technique inside surfaces, as a share of "
        "luminance. "
        "FLIP blurs these away. Quad ratio: steps between 2x2 pixels over steps within them; 1 is none.</p>\n<div class=\"scroll\" "
        "tabindex=\"0\" role=\"region\" aria-label=\"All figures\"><table>\n"
        "<tr><th scope=\"col\">technique</th><th scope=\"col\">samples</th><th scope=\"col\">surfaces</th>"
        "<th scope=\"col\">ms, median</th><th scope=\"col\">ms, p95</th><th scope=\"col\">CPU ms</th><th scope=\"col\">FLIP, mean</th>"
        "<th scope=\"col\">FLIP, p99</th><th scope=\"col\">relative MSE</th><th scope=\"col\">largest error</th>"
        "<th scope=\"col\">pattern, %</th><th scope=\"col\">quad ratio</th><th scope=\"col\">NaN pixels</th><th "
        "scope=\"col\">Pareto</th></tr>\n";
    for (const ChartRow* row : rows) {
        const RowErrors& e = row->measured.errors;
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(row->setting.budget > 0.0 ? describe(row->setting) : row->setting.technique),
            row->setting.sampled ? std::to_string(row->setting.samples) : "", escaped(describe(row->cell)), number(ms_of(*row)),
            number(p95_of(*row)), number(cpu_ms_of(*row)), number(e.flip_mean), number(e.flip_p99), number(e.rel_mse), number(e.max_abs),
            known(100.0 * e.pattern_rms), known(std::fmax(e.quad_ratio_x, e.quad_ratio_y)), e.nan_pixels, row->pareto ? "yes" : "");
    }
    return out + "</table></div></details>\n";
}

// Describes the part of an error that may be the reference's noise.
std::string noise_html(const ReferenceNoise& noise)
{
    if (!std::isfinite(noise.flip))
        return fmt::format("<p>The reference has {} samples a pixel, too few to tell its noise.</p>\n", noise.samples);
    return fmt::format(
        "<p>The reference has {} samples a pixel: 95 % of its pixels' means are within {:.2g} % of the exact values, on average over the "
        "picture. Its noise alone makes a mean HDR-FLIP of about {}: errors of that size are the reference's own.</p>\n",
        noise.samples, 100.0 * noise.relative_error, number(noise.flip));
}

// Says in words which setting the place wants at which error.
std::string wanted_html(const PlaceRows& place, const std::vector<double>& errors)
{
    std::string items;
    for (const std::string& line : wanted_settings(place.rows, place.reference->noise, errors))
        items += fmt::format("<li>{}</li>\n", escaped(line));
    return items.empty() ? ""
                         : "<p>The fastest setting of this chart within a mean error:</p>\n<ul class=\"wanted\">\n" + items + "</ul>\n";
}

std::string pair_html(const PairRows& pair, const std::vector<double>& wanted, std::size_t& place_number)
{
    std::string out = fmt::format("<section class=\"pair\">\n<h2>{} under {}</h2>\n", escaped(pair.scene), escaped(pair.env));
    if (pair.places.size() > 1) {
        out += "<p><label>Surfaces: <select class=\"cells\">";
        for (const PlaceRows& place : pair.places)
            out += fmt::format("<option>{}</option>", escaped(describe(place.cell)));
        out += "</select></label></p>\n";
    }
    for (const PlaceRows& place : pair.places) {
        out += fmt::format("<div class=\"place\" data-place=\"{}\"{}>\n", place_number++, &place == &pair.places.front() ? "" : " hidden");
        out += wanted_html(place, wanted);
        out += noise_html(place.reference->noise);
        out += charts_html(place.rows);
        out += "<h3>Pictures</h3>\n<p>In a picture: <kbd>+</kbd> <kbd>-</kbd> or a double click zoom, dragging or arrow keys move, "
               "<kbd>F</kbd> "
               "flickers, <kbd>S</kbd> <kbd>T</kbd> <kbd>R</kbd> <kbd>E</kbd> choose what is shown. All pictures follow.</p>\n"
               "<div class=\"wall\"></div>\n</div>\n";
    }
    return out + sweeps_html(pair.rows) + heats_html(pair.rows) + table_html(pair.rows) + "</section>\n";
}

Status add_row(const ChartRow& row, Json& rows)
{
    const Result<std::string> picture = data_uri(row.picture), error = data_uri(row.error_map);
    BN_TRY(picture);
    BN_TRY(error);
    rows[row.key] = {{"technique", row.setting.technique},
                     {"setting", setting_text(row)},
                     {"text", describe(row)},
                     {"figures", fmt::format("{}FLIP {}, p99 {}", row.measured.ms.empty() ? "" : number(ms_of(row)) + " ms, ",
                                             number(flip_of(row)), number(row.measured.errors.flip_p99))},
                     {"picture", *picture},
                     {"error", *error}};
    return {};
}

// Returns the data for the page's script.
Result<std::string> data_json(const ChartReport& report, const std::vector<PairRows>& pairs)
{
    Json json = {{"subject", "Technique"},
                 {"width", report.error_width},
                 {"height", report.error_height},
                 {"places", Json::array()},
                 {"rows", Json::object()}};
    for (const PairRows& pair : pairs)
        for (const PlaceRows& place : pair.places) {
            const Result<std::string> reference = data_uri(place.reference->picture);
            BN_TRY(reference);
            Json keys = Json::array(), shown = Json::array();
            for (const std::string& technique : techniques_of(place.rows)) {
                std::vector<int> samples;
                for (const ChartRow* row : place.rows)
                    if (row->setting.technique == technique)
                        samples.push_back(row->setting.samples);
                for (const ChartRow* row : place.rows)
                    if (row->setting.technique == technique && row->setting.samples == representative_samples(technique, samples))
                        shown.push_back(row->key);
            }
            for (const ChartRow* row : place.rows) {
                keys.push_back(row->key);
                BN_TRY(add_row(*row, json["rows"]));
            }
            json["places"].push_back({{"reference", *reference}, {"rows", keys}, {"shown", shown}});
        }
    return script_json(json);
}

std::string heading(const ChartReport& report)
{
    const ChartMachine& m = report.machine;
    const std::string busy =
        m.others.value_or(0.0) > kBusy
            ? fmt::format(
                  "<p><strong>Other programs took {:.0f} % of this machine's cores while the frames were timed: the times are longer "
                  "than they are alone.</strong></p>\n",
                  100.0 * *m.others)
            : "";
    const std::string times =
        report.runs == 0
            ? fmt::format("No frames were timed; burnish {}.", escaped(m.version))
            : fmt::format(
                  "Times are of frames of {} x {} pixels, {} samples a pixel: medians of {} interleaved frame{} on {}, {}, {} thread{}; "
                  "burnish {}.",
                  report.width, report.height, report.msaa, report.runs, report.runs == 1 ? "" : "s", escaped(m.processor), escaped(m.isa),
                  m.threads, m.threads == 1 ? "" : "s", escaped(m.version));
    return fmt::format(
        "<h1>Speed against accuracy</h1>\n<p>{} Errors are of pictures of {} x {} pixels: {} against Monte Carlo "
        "references of at least {} samples a pixel.</p>\n{}"
        "<p>Point at a mark, or go to it with the Tab and arrow keys, to see its picture; Enter shows it among the pictures below.</p>\n"
        "<noscript><p>The pictures need JavaScript; the charts and figures do not.</p></noscript>\n",
        times, report.error_width, report.error_height,
        report.display_flip ? "FLIP of pictures as they are shown" : "HDR-FLIP of linear pixels", report.reference_samples, busy);
}

} // namespace

std::vector<ReportFile> chart_files(const ChartReport& report)
{
    std::vector<std::pair<std::string, Drawing>> charts; // by name
    std::size_t number_of_place = 0, number_of_pair = 0;
    for (const PairRows& pair : group(report)) {
        for (const PlaceRows& place : pair.places) {
            ++number_of_place;
            for (const Figure& figure : figures_of(place.rows))
                charts.emplace_back(fmt::format("{}-{}", figure.name, number_of_place), figure.wide);
        }
        ++number_of_pair;
        for (const std::string& option : swept_numbers(pair.rows))
            if (Drawing sweep = plot_sweep(pair.rows, option, Layout::wide); !sweep.empty())
                charts.emplace_back(fmt::format("{}-flip-{}", option, number_of_pair), std::move(sweep));
        for (const std::string& technique : techniques_of(pair.rows))
            for (const bool difference : {false, true})
                if (Drawing map = plot_heat(pair.rows, technique, difference); !map.empty())
                    charts.emplace_back(fmt::format("heat-{}{}-{}", technique, difference ? "-difference" : "", number_of_pair),
                                        std::move(map));
    }
    std::vector<ReportFile> files;
    for (const auto& [name, chart] : charts)
        files.push_back({name + ".svg", svg_of(chart, chart_style())});
    return files;
}

Result<std::string> chart_page(const ChartReport& report, const std::string& live)
{
    const std::vector<PairRows> pairs = group(report);
    const Result<std::string> data = data_json(report, pairs);
    BN_TRY(data);
    std::string page = fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                                   "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                                   "<title>Speed against accuracy</title>\n<link rel=\"icon\" href=\"data:,\">\n"
                                   "<style>\n{}{}</style>\n</head>\n<body>\n<main>\n",
                                   kChartPageStyle.bytes, chart_style());
    page += heading(report);
    std::size_t place_number = 0;
    for (const PairRows& pair : pairs)
        page += pair_html(pair, report.wanted, place_number);
    page +=
        fmt::format("</main>\n<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script type=\"application/json\" id=\"data\">{}</script>\n"
                    "{}<script>\n{}</script>\n</body>\n</html>\n",
                    *data, live, kChartPageScript.bytes);
    return page;
}

} // namespace burnish
