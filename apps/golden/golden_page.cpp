// The page of a run of goldens: rows that did not pass first, each with slider, flicker and error map.
#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/golden/golden_report.h"
#include "apps/report/assets.h"
#include "apps/report/html.h"
#include "apps/report/pictures.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr int kThumbnailWidth = 160;    // pixels
constexpr std::size_t kMostWalls = 100; // rows with a slider; further ones link to their pictures

constexpr const char* kStyle = R"(
.rows { width: 100%; }
.rows td, .rows th { text-align: left; vertical-align: top; white-space: normal; overflow-wrap: anywhere; }
.verdict { white-space: nowrap; margin-left: .5rem; }
.rows img { width: 100px; height: auto; display: block; border: 1px solid var(--line); }
.differs, .failed, .missing { color: #c22; }
@media (prefers-color-scheme: dark) { .differs, .failed, .missing { color: #f77; } }
.command { white-space: nowrap; }
.tiles { grid-template-columns: minmax(0, 60rem); }
textarea { width: 100%; box-sizing: border-box; height: 6rem; }
)";

constexpr const char* kScript = R"(
(() => {
  const boxes = [...document.querySelectorAll('input.bless')], list = document.getElementById('list'), save = document.getElementById('save');
  const update = () => {
    list.value = boxes.filter(box => box.checked).map(box => JSON.stringify(box.dataset.name) + '\n').join('');
    save.href = 'data:text/plain;charset=utf-8,' + encodeURIComponent(list.value);
  };
  boxes.forEach(box => box.addEventListener('change', update));
  const all = document.getElementById('all');
  if (all) all.addEventListener('change', () => { boxes.forEach(box => { box.checked = all.checked; }); update(); });
  update();
})();
)";

// Percent-encodes a path for an address.
std::string address(const std::string& path)
{
    std::string out;
    for (const char c : path)
        if (c == '%' || c == '?' || c == '#' || c == ' ' || c == '"' || static_cast<unsigned char>(c) >= 128)
            out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        else
            out += c;
    return out;
}

// Returns a small picture within the page, or nothing where there is none.
std::string thumbnail(const std::string& path, const std::string& title)
{
    if (!file_exists(path))
        return "";
    Result<Image> image = read_image(path, Limits{});
    if (!image || image->type != PixelType::u8)
        return "";
    Image floats = make_image(image->width, image->height, image->channels, PixelType::f32);
    for (std::size_t i = 0; i < image->bytes.size(); ++i)
        floats.f32()[i] = static_cast<float>(static_cast<int>(image->bytes[i])) / 255.0f;
    const Image small = shrink(floats, kThumbnailWidth);
    Image out = make_image(small.width, small.height, small.channels, PixelType::u8);
    for (std::size_t i = 0; i < out.bytes.size(); ++i)
        out.bytes[i] = static_cast<std::byte>(std::clamp(small.f32()[i] * 255.0f + 0.5f, 0.0f, 255.0f));
    const Result<std::string> png = encode_png(out);
    return png ? fmt::format("<img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{}\" height=\"{}\">", base64(*png), title, out.width,
                             out.height)
               : "";
}

std::string link(const std::string& to, const std::string& text)
{
    return fmt::format("<a href=\"{}\">{}</a>", escaped(address(to)), text);
}

// Writes a table's row. wall: index of its slider; negative: none.
std::string row_html(const GoldenResult& r, const std::string& folder, int wall)
{
    const std::string shown = "shown/" + file_stem(r.name);
    const bool can_bless = r.verdict == GoldenVerdict::differs || r.verdict == GoldenVerdict::missing;
    std::string links = file_exists(folder + "/" + r.picture) ? link(r.picture, "picture") : "";
    if (!r.log.empty() && file_exists(folder + "/" + r.log))
        links += (links.empty() ? "" : ", ") + link(r.log, "output of its program");
    return fmt::format(
        "<tr><td>{}</td><td>{}</td><td><strong>{}</strong> <span class=\"verdict {}\">{}</span><br>{}{}{}{}</td></tr>\n",
        can_bless ? fmt::format("<input type=\"checkbox\" class=\"bless\" aria-label=\"bless {0}\" data-name=\"{0}\">", escaped(r.name))
                  : "",
        thumbnail(folder + "/" + shown + ".png", "new picture"), escaped(r.name), verdict_name(r.verdict), verdict_name(r.verdict),
        escaped(r.reason), r.reason.empty() ? "" : "<br>", links,
        wall < 0 ? "" : fmt::format("{}<a href=\"#wall-{}\">compare</a>", links.empty() ? "" : ", ", wall));
}

} // namespace

Result<std::string> golden_page(const std::vector<GoldenResult>& results, const std::string& folder)
{
    // Put rows that did not pass first
    std::vector<const GoldenResult*> ordered;
    for (const GoldenResult& r : results)
        ordered.push_back(&r);
    std::stable_sort(ordered.begin(), ordered.end(), [](const GoldenResult* a, const GoldenResult* b) {
        const bool passed_a = a->verdict == GoldenVerdict::passed, passed_b = b->verdict == GoldenVerdict::passed;
        return passed_a != passed_b ? passed_b : a->flip > b->flip;
    });
    const GoldenCounts counts = count_of(results);
    const std::size_t bad = results.size() - counts.passed;
    std::string rows, walls;
    Json places = Json::array(), data_rows = Json::object();
    for (const GoldenResult* r : ordered) {
        const std::string shown = "shown/" + file_stem(r->name);
        const bool compared =
            r->verdict != GoldenVerdict::passed && file_exists(folder + "/" + shown + "%error.png") && places.size() < kMostWalls;
        const int wall = compared ? static_cast<int>(places.size()) : -1;
        rows += row_html(*r, folder, wall);
        if (!compared)
            continue;
        const std::string key = std::to_string(wall), figures = fmt::format("FLIP {:.4f}", r->flip);
        walls += fmt::format("<section class=\"pair\" id=\"wall-{}\"><h2>{}</h2><p>{}</p>\n<div class=\"place\" data-place=\"{}\"><div "
                             "class=\"wall\"></div></div></section>\n",
                             wall, escaped(r->name), escaped(r->reason), wall);
        data_rows[key] = {{"technique", r->name},
                          {"setting", ""},
                          {"text", r->name + ", " + figures},
                          {"figures", figures},
                          {"picture", address(shown + ".png")},
                          {"error", address(shown + "%error.png")}};
        places.push_back({{"reference", address(shown + "%golden.png")},
                          {"width", r->width},
                          {"height", r->height},
                          {"rows", Json::array({key})},
                          {"shown", Json::array({key})}});
    }
    const std::string title = bad == 0 ? fmt::format("All {} golden pictures passed", results.size())
                                       : fmt::format("{} of {} golden pictures did not pass", bad, results.size());
    std::string page = fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                                   "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
                                   "<link rel=\"icon\" href=\"data:,\">\n<style>{1}{2}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
                                   "<p>{3} differ, {4} have no golden, {5} could not be made, {6} passed.</p>\n",
                                   title, kChartPageStyle.bytes, kStyle, counts.differs, counts.missing, counts.failed, counts.passed);
    page += "<table class=\"rows\">\n<tr><th>" + std::string(bad ? "<input type=\"checkbox\" id=\"all\" aria-label=\"bless all\">" : "") +
            "</th><th></th><th>picture</th></tr>\n" + rows + "</table>\n";
    if (counts.differs + counts.missing)
        page +=
            "<h2>Bless</h2>\n<p>Check the rows whose new picture is right, save the list, and run <code class=\"command\">burnish golden "
            "bless MANIFEST --from bless.txt -o RESULTS</code>. MANIFEST is that of this run, RESULTS the folder of this page; without -o "
            "it is golden-results.</p>\n<p><a id=\"save\" download=\"bless.txt\">Save the list</a></p>\n<textarea id=\"list\" readonly "
            "aria-label=\"list of rows to bless\"></textarea>\n";
    if (!places.empty())
        page += "<p>Error maps show HDR-FLIP: black is 0, purple and orange lie between, light yellow is 1.</p>\n";
    const Json data = {{"subject", "New picture"}, {"other", "Golden"}, {"width", 1}, {"height", 1},
                       {"places", places},         {"rows", data_rows}};
    return page + walls +
           fmt::format(
               "</main>\n<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script type=\"application/json\" id=\"data\">{}</script>\n"
               "<script>\n{}</script>\n<script>{}</script>\n</body>\n</html>\n",
               script_json(data), kChartPageScript.bytes, kScript);
}

} // namespace burnish
