#include "apps/lab/atlas/page.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/lab/atlas/assets.h"
#include "apps/report/assets.h"
#include "apps/report/axes.h"
#include "apps/report/chart_style.h"
#include "apps/report/drawing.h"
#include "apps/report/html.h"
#include "apps/report/svg.h"
#include "core/base/version.h"

namespace burnish {
namespace {

constexpr const char* kBroken = "c2"; // classes of both curves
constexpr const char* kCured = "c1";

std::string onset_text(const MeasuredEntry& m)
{
    return m.onset <= 1.0 ? fmt::format("{:.3f}", m.onset) : "none";
}

std::string double_text(const MeasuredEntry& m)
{
    return m.in_double ? fmt::format("{:.4f}", *m.in_double) : "not drawn";
}

// Draws three lines over the path: the tested method's error, the cure's error, and the threshold.
Drawing plot_path(const AtlasResult& r)
{
    constexpr double kWidth = 380.0, kHeight = 230.0, kLeft = 56.0, kRight = 368.0, kTop = 10.0, kBottom = 178.0;
    const bool cured = r.entry->cure[0] != 0;
    const double most = std::max({r.measured.worst, r.measured.cure_worst, r.entry->threshold});
    const Axis x{0.0, 1.0, kLeft, kRight, true}, y{0.0, 1.06 * most, kBottom, kTop, true};
    Drawing out(kWidth, kHeight, "chart", fmt::format("{}: error along the path", r.entry->id));
    for (const double tick : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        out.line({{x.at(tick), kTop}, {x.at(tick), kBottom}}, "grid");
        out.text(x.at(tick), kBottom + 17.0, "tick middle", number(tick));
    }
    for (const double tick : linear_ticks(y, 5)) {
        out.line({{kLeft, y.at(tick)}, {kRight, y.at(tick)}}, "grid");
        out.text(kLeft - 6.0, y.at(tick) + 4.5, "tick end", number(tick));
    }
    out.text((kLeft + kRight) / 2.0, kBottom + 36.0, "title middle", "place on the path");
    out.line({{kLeft, y.at(r.entry->threshold)}, {kRight, y.at(r.entry->threshold)}}, "level c0");
    out.text(kRight - 4.0, y.at(r.entry->threshold) - 4.0, "note end", "threshold");
    for (const bool cure : {true, false}) {
        if (cure && !cured)
            continue;
        const std::string colour = cure ? kCured : kBroken;
        const double legend = cure ? kRight - 44.0 : kLeft;
        out.text(legend + 12.0, kBottom + 36.0, "tick", cure ? "cure" : "breaks");
        Points line;
        for (const AtlasStep& s : r.measured.steps)
            if (!cure || s.cure_error)
                line.emplace_back(x.at(s.s), y.at(cure ? *s.cure_error : s.error));
        out.line(line, "curve " + colour);
        out.open("point best " + colour);
        for (const auto& [px, py] : line)
            out.mark(cure ? 1 : 0, px, py, 3.0, "mark");
        out.mark(cure ? 1 : 0, legend + 4.0, kBottom + 32.0, 3.0, "mark");
        out.close();
    }
    return out;
}

std::string overview(const std::vector<AtlasResult>& results)
{
    std::string out =
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All entries\"><table>\n"
        "<tr><th scope=\"col\">entry</th><th scope=\"col\">onset</th><th scope=\"col\">worst</th><th scope=\"col\">threshold</th>"
        "<th scope=\"col\">flicker</th><th scope=\"col\">in double</th><th scope=\"col\">cure</th><th scope=\"col\">kind</th><th "
        "scope=\"col\">held</th></tr>\n";
    for (const AtlasResult& r : results) {
        const MeasuredEntry& m = r.measured;
        out += fmt::format(
            "<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td>{2:.4f}</td><td>{3:g}</td><td>{4:.4f}</td><td>{9}</td><td>{5}</td>"
            "<td>{6}</td><td class=\"{8}\">{7}</td></tr>\n",
            r.entry->id, onset_text(m), m.worst, r.entry->threshold, m.flicker,
            r.entry->cure[0] ? fmt::format("{:.4f}", m.cure_worst) : "none known", m.kind, verdict_name(r.judged.verdict),
            r.judged.verdict >= Verdict::worse ? "red" : "", double_text(m));
    }
    return out + "</table></div>\n";
}

std::string pane(const AtlasResult& r, AtlasRow row, const std::string& caption)
{
    return fmt::format(
        "<figure><div class=\"pane\" data-row=\"{}\" role=\"img\" aria-label=\"{}\" style=\"background-image: url('{}')\"></div>"
        "<figcaption>{}</figcaption></figure>\n",
        static_cast<int>(row), escaped(caption), escaped(r.strip), escaped(caption));
}

Json steps_of(const AtlasResult& r)
{
    Json steps = Json::array();
    for (const AtlasStep& s : r.measured.steps)
        steps.push_back(fmt::format("s = {:.3f}: {}; off by {:.4f}{}", s.s, s.values, s.error,
                                    s.cure_error       ? fmt::format(", the cure by {:.4f}", *s.cure_error)
                                    : r.entry->cure[0] ? ", the cure was not looked at here"
                                                       : ""));
    return steps;
}

std::string section(const AtlasResult& r)
{
    const AtlasEntry& e = *r.entry;
    const MeasuredEntry& m = r.measured;
    const std::size_t last = m.steps.size() - 1;
    std::string out =
        fmt::format("<section class=\"entry\" id=\"{0}\" tabindex=\"-1\">\n<h2>{0}</h2>\n<p>{1}.</p>\n", e.id, escaped(e.breaks));
    if (r.judged.verdict >= Verdict::worse)
        out += fmt::format("<p class=\"red\"><strong>{}</strong>: {}</p>\n", verdict_name(r.judged.verdict), escaped(r.judged.why));
    out += fmt::format("<p>Onset {}, worst {:.4f} ({} in double), flicker {:.4f}: {}. Measured is the {}; its noise alone makes {}.</p>\n",
                       onset_text(m), m.worst, double_text(m), m.flicker, m.kind, escaped(measure_text(e)), number(m.noise));
    out += fmt::format("<p><code>burnish render {}</code>, {}; cure: {}</p>\n", escaped(e.words), escaped(path_text(e)),
                       e.cure[0] ? "<code>" + escaped(e.cure) + "</code>" : "none known");
    out += "<div class=\"walk\">" + svg_of(plot_path(r)) + "<div>\n";
    if (!r.strip.empty()) {
        out += fmt::format(
            "<p class=\"controls\"><label>Path <input type=\"range\" class=\"path\" min=\"0\" max=\"{0}\" value=\"{0}\" step=\"1\" "
            "aria-label=\"place on the path of {1}\"></label></p>\n<p class=\"says\" aria-live=\"polite\"></p>\n<div class=\"panes\">\n",
            last, e.id);
        out += pane(r, AtlasRow::reference, "reference") + pane(r, AtlasRow::test, "breaks") + pane(r, AtlasRow::error, "its error");
        if (e.cure[0])
            out += pane(r, AtlasRow::cure, "cure") + pane(r, AtlasRow::cure_error, "the cure's error");
        out += fmt::format("</div>\n<script type=\"application/json\" class=\"steps\">{}</script>\n", script_json(steps_of(r)));
    }
    return out + "</div></div>\n</section>\n";
}

} // namespace

std::string atlas_page(const std::vector<AtlasResult>& results, const AtlasWalk& walk, const std::string& live)
{
    const auto red = std::count_if(results.begin(), results.end(), [](const AtlasResult& r) { return r.judged.verdict >= Verdict::worse; });
    const auto unknown =
        std::count_if(results.begin(), results.end(), [](const AtlasResult& r) { return r.judged.verdict == Verdict::unknown; });
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Where methods break</title>\n"
        "<link rel=\"icon\" href=\"data:,\">\n<style>\n{}{}{}:root {{ --steps: {}; --rows: {}; }}\n</style>\n</head>\n<body>\n<main>\n"
        "<h1>Where methods break</h1>\n",
        kChartPageStyle.bytes, chart_style(), kAtlasPageStyle.bytes, walk.steps, kAtlasRows);
    page += fmt::format("<p>{} a path of {} steps from where a method holds to where it breaks, in pictures of {} x {} pixels against "
                        "references of {} samples a pixel; burnish {}. {}</p>\n",
                        results.size() == 1 ? "1 entry," : fmt::format("{} entries, each", results.size()), walk.steps, walk.side,
                        walk.side, walk.samples, escaped(version()),
                        red       ? fmt::format("<strong class=\"red\">{} not held.</strong>", red)
                        : unknown ? fmt::format("{} not blessed.", unknown)
                                  : std::string(results.size() == 1 ? "It is held." : "All are held."));
    page +=
        "<p>Keys: <kbd>N</kbd> <kbd>P</kbd> next and previous entry, <kbd>&larr;</kbd> <kbd>&rarr;</kbd> along its path, <kbd>+</kbd> "
        "<kbd>-</kbd> zoom, <kbd>F</kbd> flickers what breaks with the reference.</p>\n<noscript><p>The paths need JavaScript; curves and "
        "figures do not.</p></noscript>\n";
    page += overview(results);
    for (const AtlasResult& r : results)
        page += section(r);
    return page + fmt::format("</main>\n{}<script>\n{}</script>\n</body>\n</html>\n", live, kAtlasPageScript.bytes);
}

} // namespace burnish
