#include "apps/report/chart_style.h"

#include <fmt/core.h>

namespace burnish {
namespace {

// One colour for each technique family, safe for red-green colour blindness, with enough contrast on light and dark paper. A letter
// marks relatives within a family.
struct Tint {
    const char* name;
    unsigned light, dark; // 0xRRGGBB, on light and on dark paper
};
constexpr Tint kTints[] = {
    {"paper", 0xffffff, 0x161616}, {"ink", 0x1c1c1c, 0xececec}, {"soft", 0x5f5f5f, 0xa8a8a8}, {"grid", 0xe3e3e3, 0x343434},
    {"c0", 0x5c5c5c, 0xb5b5b5},    {"c1", 0x0067a8, 0x62b6ee},  {"c2", 0xc64f00, 0xff9d57},   {"c2a", 0x6b2a00, 0xffd9b8},
    {"c2b", 0xcf1150, 0xff7d9c},   {"c3", 0x00795a, 0x48c9a0},  {"c4", 0x9c2f86, 0xe593d6},   {"c4a", 0x56164a, 0xf8d0f1},
    {"c5", 0x7d6200, 0xe3c24e},    {"c6", 0x8a4a3a, 0xdc9d88},  {"c7", 0x3d4db7, 0xa3b1ff},   {"c8", 0x2f6f1e, 0x8fd07a},
};

struct ChartLineStyle {
    const char *css_class, *tint; // tint: null: the family's
    double width, opacity;        // px, [0,1]
    double on, off;               // px a dash and a gap, 0: none
};
constexpr ChartLineStyle kLines[] = {
    {"grid", "grid", 1.0, 1.0, 0.0, 0.0},    {"front", "soft", 5.0, 0.35, 0.0, 0.0},  {"whisker", nullptr, 1.0, 0.6, 0.0, 0.0},
    {"level", nullptr, 1.3, 0.75, 5.0, 4.0}, {"curve", nullptr, 1.3, 0.75, 0.0, 0.0},
};

// Text changes by class; several classes may apply.
struct TextChange {
    const char* css_class;
    const char* tint; // null: left as it is
    double size;      // px of the em; 0: left as it is
    double halo;      // px of paper around the letters, so that lines do not run through them; 0: left as it is
    bool bold, slanted;
};
constexpr double kTextSize = 13.0;   // px of the em
constexpr double kMarkWidth = 1.6;   // px of a mark's outline
constexpr const char* kFamily = "c"; // of the group, else ink
constexpr TextChange kTexts[] = {
    {"tick", "soft", 12.0, 0.0, false, false},
    {"note", "soft", 0.0, 0.0, false, true},
    {"name", kFamily, 0.0, 2.0, true, false},
    {"value", nullptr, 12.0, 0.0, false, false},
};

// Text colours inside coloured cells, whatever the paper.
struct CellInk {
    const char* css_class;
    unsigned rgb;
};
constexpr CellInk kCellInks[] = {{"on-dark", 0xffffff}, {"on-pale", 0x111111}};

std::string tints_css(unsigned Tint::*of)
{
    std::string css;
    for (const Tint& t : kTints)
        css += fmt::format(" --{}: #{:06x};", t.name, t.*of);
    return css;
}

} // namespace

std::string chart_style()
{
    std::string css = fmt::format("svg.chart {{{}\n  background: var(--paper); color: var(--ink); font: {:g}px system-ui, \"DejaVu Sans\", "
                                  "sans-serif; }}\n@media (prefers-color-scheme: dark) {{ svg.chart {{{} }} }}\n",
                                  tints_css(&Tint::light), kTextSize, tints_css(&Tint::dark));
    const auto rule = [&css](const std::string& selector, const std::string& body) {
        css += fmt::format("svg.chart {} {{{} }}\n", selector, body);
    };
    for (const Tint& t : kTints)
        if (t.name[0] == 'c')
            rule(fmt::format(".{}", t.name), fmt::format(" --c: var(--{});", t.name));
    rule("text", " fill: var(--ink);");
    rule(".middle", " text-anchor: middle;");
    rule(".end", " text-anchor: end;");
    for (const ChartLineStyle& l : kLines)
        rule(fmt::format(".{}", l.css_class),
             fmt::format(" stroke: var(--{}); stroke-width: {:g}; opacity: {:g}; fill: none; stroke-linejoin: round;{}",
                         l.tint ? l.tint : "c", l.width, l.opacity,
                         l.on > 0.0 ? fmt::format(" stroke-dasharray: {:g} {:g};", l.on, l.off) : ""));
    for (const TextChange& t : kTexts) {
        std::string body;
        if (t.tint)
            body += t.tint == kFamily ? " fill: var(--c, var(--ink));" : fmt::format(" fill: var(--{});", t.tint);
        if (t.size > 0.0)
            body += fmt::format(" font-size: {:g}px;", t.size);
        if (t.halo > 0.0)
            body += fmt::format(" paint-order: stroke; stroke: var(--paper); stroke-width: {:g}px; stroke-linejoin: round;", 2.0 * t.halo);
        body += t.bold ? " font-weight: 600;" : "";
        body += t.slanted ? " font-style: italic;" : "";
        rule(fmt::format("text.{}", t.css_class), body);
    }
    for (const CellInk& ink : kCellInks)
        rule(fmt::format("text.{}", ink.css_class), fmt::format(" fill: #{:06x};", ink.rgb));
    rule(".hit", " fill: transparent;");
    rule(":is(path, circle).mark", fmt::format(" stroke: var(--c); stroke-width: {:g}; fill: var(--paper);", kMarkWidth));
    rule(".best :is(path, circle).mark", " fill: var(--c);");
    return css;
}

} // namespace burnish
