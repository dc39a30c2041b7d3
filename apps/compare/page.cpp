// The page of `burnish compare --html`: one file with embedded pictures, for phones and dark mode too.
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/compare/displayed.h"
#include "apps/compare/figures.h"
#include "apps/compare/histogram.h"
#include "apps/report/assets.h"
#include "apps/report/chart_style.h"
#include "apps/report/html.h"
#include "apps/report/svg.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/magma.h"

namespace burnish {
namespace {

constexpr const char* kStyle = R"(
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr)); gap: 1rem; margin: 1rem 0; }
.pictures img { width: 100%; height: auto; display: block; border: 1px solid var(--line); }
img.small { image-rendering: pixelated; }
figcaption { overflow-wrap: anywhere; }
.tiles { grid-template-columns: minmax(0, 60rem); }
.scale { height: .8rem; border: 1px solid var(--line); }
table { margin: 1.5rem 0; }
.verdict.bad strong { color: #c22; }
@media (prefers-color-scheme: dark) { .verdict.bad strong { color: #f77; } }
th, td, td:first-child { text-align: left; vertical-align: top; white-space: normal; }
)";

Result<std::string> figure(const std::string& id, const std::string& title, const std::string& caption, const Image& image)
{
    const Result<std::string> png = encode_png(image);
    BN_TRY(png);
    return fmt::format("<figure><img id=\"{}\"{} src=\"data:image/png;base64,{}\" width=\"{}\" height=\"{}\" alt=\"{}\">\n"
                       "<figcaption><strong>{}</strong> {}</figcaption></figure>\n",
                       id, image.width < 512 ? " class=\"small\"" : "", base64(*png), image.width, image.height, title, title,
                       escaped(caption));
}

// Returns the error map's colours from 0 to 1, as a CSS gradient.
std::string scale_of_magma()
{
    Image steps = make_image(17, 1, 1, PixelType::f32);
    for (int i = 0; i < steps.width; ++i)
        steps.f32()[i] = static_cast<float>(i) / static_cast<float>(steps.width - 1);
    const Image colours = magma_map(steps);
    std::string stops;
    for (std::size_t i = 0; i < colours.bytes.size(); i += 3)
        stops += fmt::format(",rgb({},{},{})", static_cast<int>(colours.bytes[i]), static_cast<int>(colours.bytes[i + 1]),
                             static_cast<int>(colours.bytes[i + 2]));
    return fmt::format("<div class=\"scale\" style=\"background:linear-gradient(to right{})\"></div>"
                       "<div>Errors from 0 (left) to 1 (right)</div>\n",
                       stops);
}

// Returns the overlay of both pictures; the script takes the pictures from the page.
std::string wall_html()
{
    return "<noscript><p>Slider, flicker and zoom need JavaScript; pictures and figures do not.</p></noscript>\n"
           "<section class=\"pair\"><div class=\"place\" data-place=\"0\">\n<p>In the picture: <kbd>+</kbd> <kbd>-</kbd> or a double click "
           "zoom, dragging or arrow keys move, <kbd>F</kbd> flickers, <kbd>S</kbd> <kbd>T</kbd> <kbd>R</kbd> <kbd>E</kbd> choose what is "
           "shown.</p>\n<div class=\"wall\"></div>\n</div></section>\n";
}

Json wall_data(const CompareFigures& figures)
{
    const std::string flip = figures.errors ? fmt::format("FLIP {:.4f}", figures.errors->mean) : "";
    Json row = {{"technique", "Test"}, {"setting", ""},      {"text", "Test against reference, " + flip},
                {"figures", flip},     {"picture", "#test"}, {"error", "#error"}};
    Json place = {{"reference", "#reference"}, {"rows", Json::array({"0"})}, {"shown", Json::array({"0"})}};
    Json rows = Json::object();
    rows["0"] = row;
    return {{"subject", "Test"}, {"width", figures.width}, {"height", figures.height}, {"places", Json::array({place})}, {"rows", rows}};
}

} // namespace

Result<std::string> compare_page(const ComparePage& page, const CompareOptions& options, const CompareFigures& figures,
                                 const Pictures& pictures)
{
    const FlipExposures& range = figures.flip.exposures;
    const float middle = figures.asked.flip_hdr ? 0.5f * (range.start_ev + range.stop_ev) : 0.0f;
    const std::string shown = pictures.reference.type == PixelType::f32 ? fmt::format(" (shown at {:+.2f} EV)", middle) : std::string();
    const Result<std::string> parts[] = {
        figure("reference", "Reference", options.reference + shown, displayed(pictures.reference, middle)),
        figure("test", "Test", options.test + shown, displayed(pictures.test, middle)),
        figure("error", "Error", figures.asked.flip_hdr ? "HDR-FLIP" : "LDR-FLIP", magma_map(figures.flip.error))};
    std::string text = fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                                   "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                                   "<title>{0}</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>{1}{2}{3}</style>\n</head>\n<body>\n"
                                   "<main>\n<h1>{0}</h1>\n{4}",
                                   escaped(page.title), kChartPageStyle.bytes, chart_style(), kStyle, page.top);
    text += wall_html() + "<div class=\"pictures\">\n";
    for (const Result<std::string>& part : parts) {
        BN_TRY(part);
        text += *part;
    }
    text += "</div>\n" + scale_of_magma() + "<table>\n";
    text += fmt::format("<tr><th>size</th><td>{} x {}</td></tr>\n", figures.width, figures.height);
    for (const auto& [name, value] : figure_lines(options, figures))
        text += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(name), escaped(value));
    text += "</table>\n";
    if (figures.errors)
        text += "<figure><figcaption>How the errors are spread over the pixels, on a logarithmic scale.</figcaption>\n" +
                svg_of(plot_histogram(figures.flip.error, *figures.errors)) + "</figure>\n";
    return text + fmt::format(
                      "</main>\n<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script type=\"application/json\" id=\"data\">{}</script>\n"
                      "{}<script>\n{}</script>\n</body>\n</html>\n",
                      script_json(wall_data(figures)), page.live, kChartPageScript.bytes);
}

} // namespace burnish
