#include "apps/report/canvas.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/report/assets.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

struct Glyph {
    double left = 0.0, right = 0.0;
    std::vector<Points> strokes;
};

// Reads the stroke font; stroke_font.jhf documents its format.
std::vector<Glyph> read_glyphs()
{
    std::vector<Glyph> glyphs;
    std::istringstream file(kStrokeFont.bytes);
    for (std::string line; std::getline(file, line);) {
        constexpr std::size_t kPairs = 8;
        if (line.size() < kPairs + 2 || line[0] == '#')
            continue;
        const auto number = [&line](std::size_t at) { return static_cast<double>(line[at] - 'R'); };
        Glyph glyph{number(kPairs), number(kPairs + 1), {}};
        bool down = false;
        for (std::size_t at = kPairs + 2; at + 1 < line.size(); at += 2) {
            if (line[at] == ' ') {
                down = false;
                continue;
            }
            if (!down)
                glyph.strokes.emplace_back();
            down = true;
            glyph.strokes.back().emplace_back(number(at), number(at + 1));
        }
        glyphs.push_back(glyph);
    }
    return glyphs;
}

const Glyph& glyph_of(char c)
{
    static const std::vector<Glyph> glyphs = read_glyphs();
    const std::size_t at = static_cast<std::size_t>(static_cast<unsigned char>(c)) - 32u;
    return glyphs[at < glyphs.size() ? at : std::size_t{'?' - 32}];
}

constexpr double kUnit = 0.72 / 21.0;            // em: capitals are 21 units high
constexpr double kNarrow = 0.88;                 // factor on letter width: the font is wider than usual fonts
constexpr double kBaseline = 9.0;                // units
constexpr double kPen = 0.085, kBoldPen = 0.135; // em
constexpr int kFine = 4;                         // sub-pixels along a pixel's side, for filled areas

double distance_to(double x, double y, const std::pair<double, double>& a, const std::pair<double, double>& b)
{
    const double dx = b.first - a.first, dy = b.second - a.second, px = x - a.first, py = y - a.second;
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(px - t * dx, py - t * dy);
}

bool inside(const Points& outline, double x, double y)
{
    bool in = false;
    for (std::size_t i = 0, k = outline.size() - 1; i < outline.size(); k = i++) {
        const auto& [ax, ay] = outline[i];
        const auto& [bx, by] = outline[k];
        if ((ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax)
            in = !in;
    }
    return in;
}

} // namespace

Canvas::Canvas(int width, int height, const Paint& paper)
    : width_(width), height_(height), paper_(paper), pixels_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
{
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        pixels_[i] = static_cast<float>(paper[i % 3]);
}

Canvas::Box Canvas::box_of(const Points& points, double margin) const
{
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const auto& [x, y] : points) {
        x0 = std::min(x0, x), x1 = std::max(x1, x);
        y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
    const auto bounded = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
    return {bounded(std::floor(x0 - margin), width_), bounded(std::floor(y0 - margin), height_), bounded(std::ceil(x1 + margin), width_),
            bounded(std::ceil(y1 + margin), height_)};
}

// cover: coverage of the box's pixels, row by row, [0,1]. Blends in sRGB, as browsers do.
void Canvas::blend(const Box& box, const std::vector<float>& cover, const Paint& paint, double opacity)
{
    std::size_t k = 0;
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x, ++k) {
            const float part = cover[k] * static_cast<float>(opacity);
            float* to = &pixels_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x))];
            for (std::size_t c = 0; c < 3; ++c)
                to[c] += part * (static_cast<float>(paint[c]) - to[c]);
        }
}

void Canvas::strokes(const std::vector<Points>& lines, double width, const Paint& paint, double opacity)
{
    const double reach = 0.5 * width + 0.5;
    Points all;
    for (const Points& line : lines)
        all.insert(all.end(), line.begin(), line.end());
    const Box box = box_of(all, reach + 1.0);
    if (box.x0 >= box.x1 || box.y0 >= box.y1)
        return;
    const int columns = box.x1 - box.x0;
    std::vector<float> cover(static_cast<std::size_t>(columns) * static_cast<std::size_t>(box.y1 - box.y0));
    for (const Points& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i) {
            const auto &a = line[i], &b = line[std::min(i + 1, line.size() - 1)];
            const Box near = box_of({a, b}, reach + 1.0);
            for (int y = near.y0; y < near.y1; ++y)
                for (int x = near.x0; x < near.x1; ++x) {
                    const double part = std::clamp(reach - distance_to(x + 0.5, y + 0.5, a, b), 0.0, std::min(1.0, width));
                    float& to = cover[static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(columns) +
                                      static_cast<std::size_t>(x - box.x0)];
                    to = std::max(to, static_cast<float>(part));
                }
        }
    blend(box, cover, paint, opacity);
}

void Canvas::stroke(const Points& line, double width, const Paint& paint, double opacity)
{
    strokes({line}, width, paint, opacity);
}

void Canvas::dash(const Points& line, double width, double on, double off, const Paint& paint, double opacity)
{
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto &a = line[i], &b = line[i + 1];
        const double dx = b.first - a.first, dy = b.second - a.second, length = std::hypot(dx, dy);
        for (double at = 0.0; at < length; at += on + off) {
            const double end = std::min(at + on, length) / length, begin = at / length;
            stroke({{a.first + begin * dx, a.second + begin * dy}, {a.first + end * dx, a.second + end * dy}}, width, paint, opacity);
        }
    }
}

void Canvas::fill(const Points& outline, const Paint& paint)
{
    const Box box = box_of(outline, 1.0);
    std::vector<float> cover;
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x) {
            int hits = 0;
            for (int k = 0; k < kFine * kFine; ++k)
                hits += inside(outline, x + (k % kFine + 0.5) / kFine, y + (k / kFine + 0.5) / kFine);
            cover.push_back(static_cast<float>(hits) / (kFine * kFine));
        }
    blend(box, cover, paint, 1.0);
}

double text_width(const std::string& text, double size)
{
    double units = 0.0;
    for (const char c : text)
        units += glyph_of(c).right - glyph_of(c).left;
    return units * kUnit * kNarrow * size;
}

void Canvas::text(double x, double y, const std::string& text, const TextStyle& style, const Paint& paint)
{
    const double unit = kUnit * style.size, turn = style.turn_deg * kPi / 180.0, c = std::cos(turn), s = std::sin(turn);
    double pen = -style.anchor * text_width(text, style.size);
    std::vector<Points> lines;
    for (const char letter : text) {
        const Glyph& glyph = glyph_of(letter);
        for (const Points& stroke : glyph.strokes) {
            lines.emplace_back();
            for (const auto& [u, v] : stroke) {
                const double up = (v - kBaseline) * unit;
                const double along = pen + (u - glyph.left) * unit * kNarrow - (style.slanted ? 0.2 * up : 0.0);
                lines.back().emplace_back(x + along * c - up * s, y + along * s + up * c);
            }
        }
        pen += (glyph.right - glyph.left) * unit * kNarrow;
    }
    const double pen_width = (style.bold ? kBoldPen : kPen) * style.size;
    if (style.halo > 0.0)
        strokes(lines, pen_width + 2.0 * style.halo, paper_, 1.0);
    strokes(lines, pen_width, paint, 1.0);
}

Image Canvas::image() const
{
    Image out = make_image(width_, height_, 3, PixelType::u8);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        out.bytes[i] = static_cast<std::byte>(std::clamp(pixels_[i] + 0.5f, 0.0f, 255.0f));
    return out;
}

} // namespace burnish
