// The page of a run of goldens: rows that did not pass first, each with slider, flicker and error map.
#include <algorithm>
#include <fmt/core.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/golden/difference.h"
#include "apps/golden/golden_report.h"
#include "apps/report/assets.h"
#include "apps/report/html.h"
#include "apps/report/pictures.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr int kThumbnailSide = 96;                    // pixels
constexpr std::size_t kMostInlineBytes = 10'000'000u; // of thumbnails within the page; further ones are files beside it
constexpr std::size_t kMostWalls = 100;               // rows with a slider; further ones link to their pictures

constexpr const char* kStyle = R"(
.rows { width: 100%; }
.rows td, .rows th { text-align: left; vertical-align: top; white-space: normal; overflow-wrap: anywhere; }
.verdict { white-space: nowrap; margin-left: .5rem; }
.rows img { max-width: 96px; max-height: 96px; width: auto; height: auto; display: block; border: 1px solid var(--line); }
.differs, .failed, .missing { color: #c22; }
@media (prefers-color-scheme: dark) { .differs, .failed, .missing { color: #f77; } }
.command { overflow-wrap: anywhere; }
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

// Returns a small picture, or nothing where there is none: within the page while `bytes_left` lasts, then the file itself.
std::string thumbnail(const std::string& folder, const std::string& path, const std::string& title, std::size_t& bytes_left)
{
    if (!file_exists(folder + "/" + path))
        return "";
    const std::string linked = fmt::format("<img src=\"{}\" alt=\"{}\" loading=\"lazy\">", escaped(address(path)), title);
    if (bytes_left == 0)
        return linked;
    Result<Image> image = read_image(folder + "/" + path, Limits{});
    if (!image || image->type != PixelType::u8)
        return "";
    Image floats = make_image(image->width, image->height, image->channels, PixelType::f32);
    for (std::size_t i = 0; i < image->bytes.size(); ++i)
        floats.f32()[i] = static_cast<float>(static_cast<int>(image->bytes[i])) / 255.0f;
    const Image small = shrink_within(floats, kThumbnailSide);
    Image out = make_image(small.width, small.height, small.channels, PixelType::u8);
    for (std::size_t i = 0; i < out.bytes.size(); ++i)
        out.bytes[i] = static_cast<std::byte>(std::clamp(small.f32()[i] * 255.0f + 0.5f, 0.0f, 255.0f));
    const Result<std::string> png = encode_png(out);
    if (!png)
        return "";
    const std::string text = base64(*png);
    if (text.size() > bytes_left) {
        bytes_left = 0;
        return linked;
    }
    bytes_left -= text.size();
    return fmt::format("<img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{}\" height=\"{}\">", text, title, out.width, out.height);
}

std::string link(const std::string& to, const std::string& text)
{
    return fmt::format("<a href=\"{}\">{}</a>", escaped(address(to)), text);
}

// Writes a table's row. wall: index of its slider; negative: none.
std::string row_html(const GoldenResult& r, const std::string& folder, int wall, std::size_t& bytes_left)
{
    std::string links;
    for (const auto& [path, text] : {std::pair{r.picture, "new picture"}, {r.golden_copy, "golden"}, {r.log, "output of its program"}})
        if (!path.empty() && file_exists(folder + "/" + path))
            links += (links.empty() ? "" : ", ") + link(path, text);
    if (wall >= 0)
        links += fmt::format("{}<a href=\"#wall-{}\">compare</a>", links.empty() ? "" : ", ", wall);
    return fmt::format(
        "<tr><td>{}</td><td>{}</td><td><strong>{}</strong> <span class=\"verdict {}\">{}</span><br>{}{}{}</td></tr>\n",
        can_bless(r) ? fmt::format("<input type=\"checkbox\" class=\"bless\" aria-label=\"bless {0}\" data-name=\"{0}\">", escaped(r.name))
                     : "",
        thumbnail(folder, "shown/" + file_stem(r.name) + ".png", "new picture", bytes_left), escaped(r.name), verdict_name(r.verdict),
        verdict_name(r.verdict), escaped(r.reason), r.reason.empty() ? "" : "<br>", links);
}

// Returns a result's mean FLIP in words. Results may come from somebody else, with a map and no figures.
std::string figures_of(const GoldenResult& r)
{
    return r.flip ? fmt::format("{}-FLIP {:.4f}", r.linear ? "HDR" : "LDR", *r.flip) : "not measured";
}

// Returns a row's place in the page: failed rows first, then those that differ, those without a golden, and those that passed.
int rank_of(GoldenVerdict verdict)
{
    constexpr GoldenVerdict kOrder[] = {GoldenVerdict::failed, GoldenVerdict::differs, GoldenVerdict::missing, GoldenVerdict::passed};
    return static_cast<int>(std::find(std::begin(kOrder), std::end(kOrder), verdict) - std::begin(kOrder));
}

// Adds the pictures at other exposures to a slider's place and row, where there are files of these.
void add_exposures(const std::string& folder, const std::string& shown, Json& place, Json& row)
{
    if (!file_exists(folder + "/" + shown + exposure_ending(kMoreExposures[0])))
        return;
    Json steps = Json::array(), pictures = Json::array();
    std::vector<int> all(std::begin(kMoreExposures), std::end(kMoreExposures));
    all.push_back(0);
    std::sort(all.begin(), all.end());
    for (const int stops : all) {
        steps.push_back({{"stops", stops}, {"reference", address(shown + "%golden" + exposure_ending(stops))}});
        pictures.push_back(address(shown + exposure_ending(stops)));
    }
    place["exposures"] = steps, row["exposures"] = pictures;
}

// Returns failed rows first, and among equal verdicts large errors first.
std::vector<const GoldenResult*> order_results(const std::vector<GoldenResult>& results)
{
    std::vector<const GoldenResult*> ordered;
    for (const GoldenResult& r : results)
        ordered.push_back(&r);
    std::stable_sort(ordered.begin(), ordered.end(), [](const GoldenResult* a, const GoldenResult* b) {
        const int rank_a = rank_of(a->verdict), rank_b = rank_of(b->verdict);
        return rank_a != rank_b ? rank_a < rank_b : a->flip > b->flip;
    });
    return ordered;
}

// The page's rows and sliders.
struct PageRows {
    std::string rows, walls;
    Json places = Json::array(), data_rows = Json::object();
    std::size_t compared = 0; // rows with an error map
};

// Adds a row's slider. wall: its index.
void add_slider(const GoldenResult& r, const std::string& folder, int wall, PageRows& page)
{
    const std::string shown = "shown/" + file_stem(r.name);
    const std::string key = std::to_string(wall), figures = figures_of(r);
    page.walls += fmt::format("<section class=\"pair\" id=\"wall-{}\"><h2>{}</h2><p>{}</p>\n<div class=\"place\" data-place=\"{}\"><div "
                              "class=\"wall\"></div></div></section>\n",
                              wall, escaped(r.name), escaped(r.reason), wall);
    Json row = {{"technique", r.name},
                {"setting", ""},
                {"text", r.name + ", " + figures},
                {"figures", figures},
                {"picture", address(shown + ".png")},
                {"live", r.name},
                {"error", address(shown + "%error.png")}};
    Json place = {{"reference", address(shown + "%golden.png")},
                  {"width", r.width},
                  {"height", r.height},
                  {"rows", Json::array({key})},
                  {"shown", Json::array({key})}};
    add_exposures(folder, shown, place, row);
    page.data_rows[key] = std::move(row);
    page.places.push_back(std::move(place));
}

// Returns all rows, and sliders for the first of those that have an error map.
PageRows fill_page(const std::vector<const GoldenResult*>& ordered, const std::string& folder)
{
    PageRows page;
    std::size_t bytes_left = kMostInlineBytes;
    for (const GoldenResult* r : ordered) {
        const bool has_map = r->verdict != GoldenVerdict::passed && file_exists(folder + "/shown/" + file_stem(r->name) + "%error.png");
        page.compared += has_map;
        const int wall = has_map && page.places.size() < kMostWalls ? static_cast<int>(page.places.size()) : -1;
        page.rows += row_html(*r, folder, wall, bytes_left);
        if (wall >= 0)
            add_slider(*r, folder, wall, page);
    }
    return page;
}

// Returns the page's beginning, to the counts.
std::string write_page_head(const std::vector<GoldenResult>& results)
{
    const GoldenCounts counts = count_of(results);
    const std::size_t bad = results.size() - counts.passed;
    const std::string title = bad == 0 ? fmt::format("All {} golden pictures passed", results.size())
                                       : fmt::format("{} of {} golden pictures did not pass", bad, results.size());
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
                       "<link rel=\"icon\" href=\"data:,\">\n<style>{1}{2}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
                       "<p>{3}.</p>\n",
                       title, kChartPageStyle.bytes, kStyle, counts_in_words(counts));
}

} // namespace

Result<std::string> golden_page(const std::vector<GoldenResult>& results, const std::string& folder, const std::string& live)
{
    const PageRows made = fill_page(order_results(results), folder);
    const bool blessable = std::any_of(results.begin(), results.end(), can_bless);
    std::string page = write_page_head(results);
    page += "<table class=\"rows\">\n<tr><th>" +
            std::string(blessable ? "<input type=\"checkbox\" id=\"all\" aria-label=\"bless all\">" : "") +
            "</th><th></th><th>picture</th></tr>\n" + made.rows + "</table>\n";
    if (blessable)
        page +=
            "<h2>Bless</h2>\n<p>Check the rows whose new picture is right, save the list, and run <code class=\"command\">burnish golden "
            "bless MANIFEST --from bless.txt -o RESULTS</code>. MANIFEST is that of this run, RESULTS the folder of this page; without -o "
            "it is golden-results.</p>\n<p><a id=\"save\" download=\"bless.txt\">Save the list</a></p>\n<textarea id=\"list\" readonly "
            "aria-label=\"list of rows to bless\"></textarea>\n";
    if (!made.places.empty())
        page += "<p>Error maps show FLIP (HDR-FLIP for linear pictures, LDR-FLIP for others): black is 0, purple and orange lie between, "
                "light yellow is 1.</p>\n";
    if (made.compared > made.places.size())
        page += fmt::format("<p>The first {} of {} pictures that differ have a slider here; the table links the others.</p>\n",
                            made.places.size(), made.compared);
    const Json data = {{"subject", "New picture"}, {"other", "Golden"},     {"width", 1}, {"height", 1},
                       {"places", made.places},    {"rows", made.data_rows}};
    return page + made.walls +
           fmt::format(
               "</main>\n<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script type=\"application/json\" id=\"data\">{}</script>\n"
               "{}<script>\n{}</script>\n<script>{}</script>\n</body>\n</html>\n",
               script_json(data), live, kChartPageScript.bytes, kScript);
}

} // namespace burnish
