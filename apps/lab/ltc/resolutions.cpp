#include "apps/lab/ltc/resolutions.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/bake_ltc.h"
#include "shading/lab/ltc/polygon.h"
#include "shading/lab/ltc/sparse_table.h"

namespace burnish {
namespace {

constexpr std::size_t kLobes = 64;
constexpr int kSizes[] = {8, 12, 16, 64};
constexpr int kMostDrawn = 16;  // nodes along an axis: a ball touches thousands of finer nodes
constexpr int kBallPixels = 56; // pixels along a ball's side
constexpr double kAlpha = 0.45, kLambda = 0.2;

using ltc::Vec;
using Quad = std::vector<Vec>;

// Light strips beside a unit ball at the origin, seen along z.
constexpr Vec kStrips[2][4] = {{{-1.6, 1.2, 2.2}, {-1.2, 1.2, 2.2}, {-1.2, -1.2, 2.2}, {-1.6, -1.2, 2.2}},
                               {{0.3, 2.0, -1.0}, {0.7, 2.0, -1.0}, {0.7, 2.0, 1.5}, {0.3, 2.0, 1.5}}};

struct Pixel { // a ball pixel: its lobe, and the strips in the lobe's frame
    ltc::Place place;
    Quad strips[2];
};

// The grain runs along circles about y. Mirrors each lobe and its strips into the table's quadrant.
Pixel pixel_at(double x, double y)
{
    const Vec n = {x, y, std::sqrt(1.0 - x * x - y * y)}, tangent = ltc::unit({n.z, 0.0, -n.x}), bitangent = ltc::cross(n, tangent);
    const double sx = tangent.z < 0.0 ? -1.0 : 1.0, sy = bitangent.z < 0.0 ? -1.0 : 1.0;
    Pixel pixel;
    pixel.place = {std::min(det_atan2(std::sqrt(std::max(0.0, 1.0 - n.z * n.z)), n.z), ltc::Grid::kMostTheta),
                   det_atan2(sy * bitangent.z, sx * tangent.z), kAlpha, kLambda};
    for (int s = 0; s < 2; ++s)
        for (const Vec& corner : kStrips[s]) {
            const Vec l = {corner.x - n.x, corner.y - n.y, corner.z - n.z};
            pixel.strips[s].push_back({sx * dot(tangent, l), sy * dot(bitangent, l), dot(n, l)});
        }
    return pixel;
}

double light_by(const ltc::Matrix& m, const Pixel& pixel)
{
    const ltc::Matrix n = ltc::inverse(m);
    return polygon_part(n, pixel.strips[0]) + polygon_part(n, pixel.strips[1]);
}

struct Ball {
    std::vector<Pixel> pixels;
    std::vector<std::size_t> at; // pixel index in the picture
    std::vector<ltc::Matrix> exact;
    std::vector<double> light; // reflected by the lobes themselves
};

Ball make_ball(const Jobs& jobs)
{
    Ball ball;
    for (int row = 0; row < kBallPixels; ++row)
        for (int column = 0; column < kBallPixels; ++column) {
            const double x = 2.0 * (column + 0.5) / kBallPixels - 1.0, y = 1.0 - 2.0 * (row + 0.5) / kBallPixels;
            if (x * x + y * y < 0.999)
                ball.pixels.push_back(pixel_at(x, y)), ball.at.push_back(static_cast<std::size_t>(row * kBallPixels + column));
        }
    ball.exact.resize(ball.pixels.size()), ball.light.resize(ball.pixels.size());
    const ltc::Rule rule(14), fine(19);
    jobs.parallel_for(ball.pixels.size(), [&](std::size_t i, int) {
        const Pixel& pixel = ball.pixels[i];
        const ltc::Lobe lobe = normalised_lobe(pixel.place, fine);
        ball.exact[i] = fit_lobe(ltc::LobePoints(lobe, rule), natural_matrix(pixel.place), 0).m;
        for (const Quad& strip : pixel.strips)
            ball.light[i] += light_of_quad(lobe, ball.exact[i], strip, fine);
    });
    return ball;
}

// of_lobes, of_pixels: one matrix a lobe and a ball pixel; of_pixels may be empty.
LtcResolution row_of(const std::string& name, const std::vector<ltc::Place>& places, const std::vector<ltc::Matrix>& of_lobes,
                     const Ball& ball, const std::vector<ltc::Matrix>& of_pixels, const Jobs& jobs)
{
    LtcResolution row;
    row.name = name;
    std::vector<double> l1, light;
    for (const ltc::Judged& j : ltc::judge_matrices(places, of_lobes, jobs)) {
        l1.push_back(j.l1);
        light.insert(light.end(), j.light_relative, j.light_relative + ltc::kLights);
    }
    row.l1 = ltc::spread_of(l1), row.light_relative = ltc::spread_of(light);
    if (of_pixels.empty())
        return row;
    row.pixels.assign(kBallPixels * kBallPixels, std::numeric_limits<double>::quiet_NaN());
    row.apart = row.pixels;
    for (std::size_t i = 0; i < of_pixels.size(); ++i) {
        const double light_here = light_by(of_pixels[i], ball.pixels[i]), off = std::abs(light_here - ball.light[i]);
        row.pixels[ball.at[i]] = light_here, row.apart[ball.at[i]] = off;
        row.mean_apart += off / static_cast<double>(of_pixels.size());
    }
    return row;
}

// Draws cells, with runs of one shade as one rectangle. white: the value drawn white.
void draw_pixels(Drawing& out, const std::vector<double>& values, double x, double y, double side, double white)
{
    const double cell = side / kBallPixels;
    for (int row = 0; row < kBallPixels; ++row) {
        const auto shade_of = [&](int column) {
            const double v = values[static_cast<std::size_t>(row * kBallPixels + column)];
            return std::isnan(v) ? -1.0 : std::round(63.0 * std::sqrt(std::clamp(v / white, 0.0, 1.0))) / 63.0;
        };
        for (int begin = 0, end; begin < kBallPixels; begin = end) {
            const double shade = shade_of(begin);
            for (end = begin + 1; end < kBallPixels && shade_of(end) == shade;)
                ++end;
            if (shade >= 0.0)
                out.rectangle(x + cell * begin, y + cell * row, cell * (end - begin) + 0.3, cell + 0.3, "",
                              Paint{255.0 * shade, 255.0 * shade, 255.0 * shade});
        }
    }
}

} // namespace

LtcResolutions measure_resolutions(const ltc::Table& table, const Jobs& jobs)
{
    LtcResolutions all;
    const std::vector<ltc::Place> places = ltc::judged_places(kLobes, 0, 5000);
    all.lobes = places.size();
    const Ball ball = make_ball(jobs);
    all.reference.assign(kBallPixels * kBallPixels, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < ball.at.size(); ++i)
        all.reference[ball.at[i]] = ball.light[i];
    const auto each = [](std::size_t count, const auto& matrix) {
        std::vector<ltc::Matrix> m;
        for (std::size_t i = 0; i < count; ++i)
            m.push_back(matrix(i));
        return m;
    };
    all.rows.push_back(row_of("this table", places, each(places.size(), [&](std::size_t i) { return lookup(table, places[i]).m; }), ball,
                              each(ball.pixels.size(), [&](std::size_t i) { return lookup(table, ball.pixels[i].place).m; }), jobs));
    for (const int size : kSizes) {
        std::vector<ltc::Place> wanted = places;
        if (size <= kMostDrawn)
            for (const Pixel& pixel : ball.pixels)
                wanted.push_back(pixel.place);
        const ltc::SparseTable sparse(ltc::grid_of(size), wanted, jobs);
        all.rows.push_back(row_of(
            fmt::format("{} nodes", size), places, each(places.size(), [&](std::size_t i) { return sparse.lookup(places[i]); }), ball,
            each(size <= kMostDrawn ? ball.pixels.size() : 0, [&](std::size_t i) { return sparse.lookup(ball.pixels[i].place); }), jobs));
    }
    std::vector<ltc::Matrix> exact(places.size());
    const ltc::Rule rule(15), white(18);
    jobs.parallel_for(places.size(), [&](std::size_t i, int) {
        exact[i] = fit_lobe(ltc::LobePoints(normalised_lobe(places[i], white), rule), natural_matrix(places[i]), 0).m;
    });
    all.rows.push_back(row_of("exact", places, exact, ball, ball.exact, jobs));
    return all;
}

std::string resolution_lines(const LtcResolutions& all)
{
    std::string text = fmt::format("{:<12} {:>5}  {:>7} {:>7} {:>7} {:>7}  {:>7} {:>7}  {:>7}\n", "resolution", "", "L1", "p95", "max", "",
                                   "light", "p95", "ball");
    for (const LtcResolution& row : all.rows)
        text += fmt::format("{:<12} {:>5}  {:7.4f} {:7.4f} {:7.4f} {:>7}  {:7.4f} {:7.4f}  {:>7}\n", row.name, all.lobes, row.l1.mean,
                            row.l1.p95, row.l1.most, "", row.light_relative.mean, row.light_relative.p95,
                            row.pixels.empty() ? "" : fmt::format("{:.5f}", row.mean_apart));
    return text;
}

Json resolution_json(const LtcResolutions& all)
{
    Json rows = Json::array();
    for (const LtcResolution& row : all.rows) {
        Json one = {{"table", row.name},
                    {"l1", {{"mean", row.l1.mean}, {"p95", row.l1.p95}, {"max", row.l1.most}}},
                    {"light_relative", {{"mean", row.light_relative.mean}, {"p95", row.light_relative.p95}}}};
        if (!row.pixels.empty())
            one["ball_absolute"] = row.mean_apart;
        rows.push_back(std::move(one));
    }
    return {{"lobes", all.lobes}, {"rows", rows}};
}

Drawing plot_resolutions(const LtcResolutions& all)
{
    constexpr double kBall = 190.0, kGap = 16.0, kFirstBall = 64.0, kTimes = 5.0;
    std::vector<const LtcResolution*> drawn;
    for (const LtcResolution& row : all.rows)
        if (!row.pixels.empty())
            drawn.push_back(&row);
    double most = 1e-9;
    for (const double v : all.reference)
        most = std::max(most, std::isnan(v) ? 0.0 : v);
    Drawing out(kGap + (kBall + kGap) * (1.0 + static_cast<double>(drawn.size())), kFirstBall + 2.0 * (kBall + 44.0) + 40.0, "chart",
                "Transformed cosines by finer tables");
    out.text(kGap, 24.0, "name",
             fmt::format("A brushed ball of alpha {:g} and {:g} under two strips; below, how far from GGX, {:g} times", kAlpha,
                         kAlpha * kLambda, kTimes));
    const auto place = [&](std::size_t column) { return kGap + (kBall + kGap) * static_cast<double>(column); };
    draw_pixels(out, all.reference, place(0), kFirstBall, kBall, most);
    out.text(place(0) + kBall / 2.0, kFirstBall - 8.0, "title middle", "GGX");
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const LtcResolution& row = *drawn[i];
        const double x = place(i + 1), below = kFirstBall + kBall + 44.0;
        draw_pixels(out, row.pixels, x, kFirstBall, kBall, most);
        out.text(x + kBall / 2.0, kFirstBall - 8.0, "title middle", row.name);
        draw_pixels(out, row.apart, x, below, kBall, most / kTimes);
        out.text(x + kBall / 2.0, below - 8.0, "tick middle", fmt::format("mean {:.5f}", row.mean_apart));
    }
    std::string note = fmt::format("Mean L1 over {} lobes: ", all.lobes);
    for (const LtcResolution& row : all.rows)
        note += fmt::format("{}{} {:.4f}", &row == all.rows.data() ? "" : ", ", row.name, row.l1.mean);
    out.text(kGap, out.height - 18.0, "note",
             note + ". Of tables by nodes along an axis only those that these lobes lie between are fitted, each alone.");
    return out;
}

} // namespace burnish
