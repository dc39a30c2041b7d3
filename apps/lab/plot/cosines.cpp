// `burnish plot ltc`: the figures of linearly transformed cosines.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fmt/core.h>
#include <functional>

#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "core/jobs/jobs.h"
#include "shading/bake/ltc/table.h"
#include "shading/lab/ltc/pair_fit.h"
#include "shading/lab/ltc/quality.h"

namespace burnish {
namespace {

using ltc::determinant;
using ltc::inverse;
using ltc::Matrix;
using ltc::with_unit_axis;
using ltc::operator*;

constexpr int kColumns = 5;
constexpr double kRow = kSide + 66.0; // px, from one row of panels to the next
constexpr std::size_t kCounted = 16;  // lobes tested for broken fits
constexpr double kBroken = 0.1;       // a fit is broken if its L1 exceeds the nearest fit's by this

double of_direction(const Place& p, const std::function<double(const ltc::Vec&)>& value)
{
    const double z2 = 1.0 - p.x * p.x - p.y * p.y;
    return z2 > 0.0 ? value({p.x, p.y, std::sqrt(z2)}) : 0.0;
}

// Returns the mean squared distance between a cosine's points and their images under the matrix. Alignment minimizes this, equation 12.
double squared_way(const Matrix& m)
{
    static const ltc::Rule rule(16);
    double sum = 0.0;
    for (const ltc::Rule::Point& point : rule.points) {
        const ltc::Vec to = ltc::unit(m * point.clamped), way = {to.x - point.clamped.x, to.y - point.clamped.y, to.z - point.clamped.z};
        sum += dot(way, way) / static_cast<double>(rule.points.size());
    }
    return sum;
}

class Sheet {
  public:
    explicit Sheet(int rows, const std::string& title)
        : drawing(kColumns * (kSide + kGap) + kGap, kTop + rows * kRow + 40.0, "chart", title)
    {
    }

    void density(int row, int column, const std::string& title, const std::function<double(const ltc::Vec&)>& value)
    {
        const Panel panel{title.c_str(), kGap + column * (kSide + kGap), 1.0, kTop + row * kRow};
        draw_density(drawing, panel, Edge::horizon, [&](const Place& p) { return of_direction(p, value); });
        draw_frame(drawing, panel, Edge::horizon);
    }

    void cosine(int row, int column, const std::string& title, const Matrix& m)
    {
        const Matrix n = inverse(m);
        density(row, column, title, [&](const ltc::Vec& l) { return ltc::transformed_cosine(n, l); });
    }

    // Draws points of the plain cosine, with lines to their images under the matrix. For the last row.
    void carried(int column, const char* how, const Matrix& m)
    {
        const ltc::Rule shown(11);
        const std::string title = fmt::format("{}, mean squared way {:.3f}", how, squared_way(m));
        const Panel panel{title.c_str(), kGap + column * (kSide + kGap), 1.0, kTop + 5 * kRow};
        draw_frame(drawing, panel, Edge::horizon);
        const auto on_panel = [](const ltc::Vec& v) { return Place{v.x, v.y}; };
        for (const ltc::Rule::Point& point : shown.points) {
            const ltc::Vec to = ltc::unit(m * point.clamped);
            drawing.open("c0");
            drawing.line({panel.at(on_panel(point.clamped)), panel.at(on_panel(to))}, "curve");
            drawing.close();
            draw_dot(drawing, panel, on_panel(point.clamped), 2.5, "c5");
            draw_dot(drawing, panel, on_panel(to), 2.5, "c3");
        }
        if (column == 0)
            drawing.text(kGap, panel.top + kSide + 34.0, "note", "points of the cosine (ochre) and where the matrix takes them (green)");
    }

    Drawing drawing;
};

std::string titled(const char* name, double l1)
{
    return fmt::format("{}, L1 {:.3f}", name, l1);
}

std::string marked(const char* name, double l1) // marks lobes that one cosine cannot follow
{
    return titled(name, l1) + (l1 > ltc::kFarOff ? ": a lune" : "");
}

Matrix turned_about_z(double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
}

// Aligns as the paper does: the best of many rotations, each with and without a flip. Two flips are a rotation.
Matrix aligned_by_searching(const Matrix& m)
{
    constexpr int kTurns = 360;
    Matrix best = m;
    double least = squared_way(m);
    for (int turn = 0; turn < 2 * kTurns; ++turn) {
        const double flip = turn < kTurns ? 1.0 : -1.0;
        const Matrix other = m * turned_about_z(2.0 * kPi * turn / kTurns) * Matrix{flip, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
        if (const double way = squared_way(other); way < least)
            best = other, least = way;
    }
    return best;
}

Matrix middle_of(const Matrix& a, const Matrix& b)
{
    Matrix m;
    for (std::size_t e = 0; e < 9; ++e)
        m[e] = 0.5 * (a[e] + b[e]);
    return with_unit_axis(m);
}

// Start of a fit: an ellipse about the mirror direction, a narrow lobe that does not overlap the fitted lobe, or the plain cosine.
struct Start {
    const char* name;
    Matrix m;
};
std::array<Start, 3> starts_of(const ltc::Place& place)
{
    const ltc::Grid about; // its frames are about the mirror direction
    const auto ellipse = [&](const ltc::Place& p) {
        return with_unit_axis(about.frame(p) * Matrix{p.alpha, 0.0, 0.0, 0.0, p.alpha * p.lambda, 0.0, 0.0, 0.0, 1.0});
    };
    const ltc::Place apart = {place.theta > 0.6 ? 0.0 : 1.3, place.phi, 0.03, 1.0};
    return {
        {{"an ellipse", ellipse(place)}, {"apart", ellipse(apart)}, {"the plain cosine", {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}}}};
}

// Fits in the L3 norm and the sliced distance from `start`, and as burnish does from its own start.
std::array<ltc::NodeFit, 3> fits_from(const ltc::LobePoints& points, const ltc::Place& place, const Matrix& start)
{
    ltc::NodeFit cubed = fit_lobe(points, start, 0, ltc::Norm::l3);
    cubed.l1 = l1_distance(points, cubed.m);
    return {cubed, fit_sliced(points, start, 0), fit_lobe(points, natural_matrix(place), 0)};
}

constexpr const char* kFits[] = {"third power", "sliced distance", "burnish"};

std::string count_broken(bool quiet)
{
    const ltc::Rule rule(13), white(17);
    std::array<std::array<std::atomic<int>, 3>, 3> broken{};
    const std::vector<ltc::Place> places = ltc::judged_places(kCounted, 0, 0);
    Progress progress("lobes", places.size(), quiet);
    const Jobs jobs;
    jobs.parallel_for_whole(places.size(), [&](std::size_t i, int) {
        const ltc::Place& place = places[i];
        const ltc::LobePoints points(normalised_lobe(place, white), rule);
        const std::array<Start, 3> starts = starts_of(place);
        std::array<std::array<ltc::NodeFit, 3>, 3> fits = {};
        double least = 2.0;
        for (std::size_t s = 0; s < 3; ++s) {
            fits[s] = fits_from(points, place, starts[s].m);
            for (const ltc::NodeFit& fit : fits[s])
                least = std::min(least, fit.l1);
        }
        for (std::size_t s = 0; s < 3; ++s)
            for (std::size_t f = 0; f < 3; ++f)
                broken[f][s] += fits[s][f].l1 > least + kBroken ? 1 : 0;
        progress.step();
    });
    std::string text = fmt::format("of {} lobes, fits that end {:g} or more above the nearest of all, from an ellipse, apart and the plain "
                                   "cosine (burnish has a start of its own): ",
                                   kCounted, kBroken);
    for (std::size_t f = 0; f < 3; ++f)
        text += fmt::format("{}{} {}, {}, {}", f ? "; " : "", kFits[f], broken[f][0].load(), broken[f][1].load(), broken[f][2].load());
    return text;
}

} // namespace

Drawing plot_ltc(const LobePlot& plot, const ltc::Table& of, bool quiet)
{
    const double a = plot.roughness * plot.roughness, eta = std::abs(plot.anisotropy);
    const auto folded = [](double degrees) { return std::abs(std::remainder(degrees, 180.0)) * kDegree; };
    // Mirrors the lobe into the tables' quadrant and orders the widths as tables do.
    const ltc::Place place = {plot.theta_deg * kDegree, folded(plot.anisotropy < 0.0 ? 90.0 - plot.phi_deg : plot.phi_deg), a * (1.0 + eta),
                              std::max((1.0 - eta) / (1.0 + eta), 0.02)};
    // Fit the lobe: from the table, by one cosine and by two
    const ltc::Rule rule(15), white(18);
    const ltc::LobePoints points(normalised_lobe(place, white), rule);
    const Matrix table = lookup(of, place).m;
    const ltc::NodeFit best = fit_lobe(points, natural_matrix(place), 0);
    const ltc::PairFit pair = fit_pair(points, best.m);

    // First row: the lobe and its approximations
    Sheet sheet(6, fmt::format("Transformed cosines of a GGX lobe of alpha {:g} and {:g}", place.alpha, place.alpha * place.lambda));
    const auto lobe = [&](const ltc::Vec& l) { return density(points.lobe, l).reflected; };
    const Matrix n[2] = {inverse(pair.m[0]), inverse(pair.m[1])};
    sheet.density(0, 0, "GGX", lobe);
    sheet.cosine(0, 1, marked("the table", l1_distance(points, table)), table);
    sheet.cosine(0, 2, marked("the nearest cosine", best.l1), best.m);
    sheet.density(0, 3, marked("the nearest two", pair.l1), [&](const ltc::Vec& l) {
        return pair.share * transformed_cosine(n[0], l) + (1.0 - pair.share) * transformed_cosine(n[1], l);
    });
    const Matrix of_table = inverse(table);
    sheet.density(0, 4, "table and GGX apart", [&](const ltc::Vec& l) { return std::abs(lobe(l) - transformed_cosine(of_table, l)); });

    // Rows 2 to 4: fits from three starts
    const std::array<Start, 3> starts = starts_of(place);
    for (int s = 0; s < 3; ++s) {
        const Start& start = starts[static_cast<std::size_t>(s)];
        sheet.cosine(1 + s, 0, titled(start.name, l1_distance(points, start.m)), start.m);
        const std::array<ltc::NodeFit, 3> fits = fits_from(points, place, start.m);
        for (std::size_t f = 0; f < 3; ++f)
            sheet.cosine(1 + s, 1 + static_cast<int>(f), titled(kFits[f], fits[f].l1), fits[f].m);
    }

    // Row 5: averages of two matrices, rotated and aligned
    const Matrix turned = best.m * turned_about_z(2.0);
    ltc::Place beside = place;
    beside.theta = place.theta > 0.25 ? place.theta - 0.22 : place.theta + 0.22; // the next node
    const Matrix other = fit_lobe(ltc::LobePoints(normalised_lobe(beside, white), rule), natural_matrix(beside), 0).m;
    ltc::Place between = place;
    between.theta = 0.5 * (place.theta + beside.theta);
    const ltc::LobePoints there(normalised_lobe(between, white), rule);
    const auto mixed = [&](int column, const char* name, const ltc::LobePoints& target, const Matrix& m) {
        sheet.cosine(4, column, titled(name, determinant(m) > 0.0 ? l1_distance(target, m) : 2.0), m);
    };
    mixed(0, "a lobe with itself, turned", points, middle_of(best.m, turned));
    mixed(1, "the same, aligned", points, middle_of(in_natural_gauge(best.m, place), in_natural_gauge(turned, place)));
    mixed(2, "with a neighbour, turned", there, middle_of(other, turned));
    mixed(3, "the same, aligned", there, middle_of(in_natural_gauge(other, beside), in_natural_gauge(turned, place)));
    sheet.density(4, 4, "GGX between the two", [&](const ltc::Vec& l) { return density(there.lobe, l).reflected; });
    // Last row: the points of the cosine under each matrix
    sheet.carried(0, "turned", turned);
    sheet.carried(1, "aligned in closed form", in_natural_gauge(turned, place));
    sheet.carried(2, "aligned by searching", aligned_by_searching(turned));
    const double below = kTop + 6.0 * kRow - 8.0;
    sheet.drawing.text(
        kGap, below, "note",
        fmt::format("seen from {:g} degrees off the normal, {:g} about it from the wide axis", place.theta / kDegree, place.phi / kDegree));
    sheet.drawing.text(kGap, below + 22.0, "note", count_broken(quiet));
    return sheet.drawing;
}

} // namespace burnish
