#include "shading/bake/tables/slope_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kMostSteps = 200;
constexpr double kStepEnd = 1e-7;       // relative change of the scatter that ends the fit
constexpr double kLeastScatter = 1e-12; // squared slope; a plane has none
constexpr double kSharp = 1e-3;         // widths that shading takes for this one
constexpr int kRings = kSlopeCells / 8; // times eight sectors

struct Scatter { // a symmetric matrix
    double xx = 0.0, xy = 0.0, yy = 0.0;
    double determinant() const { return xx * yy - xy * xy; }
};

// Returns d^T S^-1 d.
double squared_distance(const Scatter& s, const glm::dvec2& d)
{
    return (s.yy * d.x * d.x - 2.0 * s.xy * d.x * d.y + s.xx * d.y * d.y) / s.determinant();
}

Scatter with_floor(Scatter s)
{
    s.xx += kLeastScatter, s.yy += kLeastScatter;
    return s;
}

// Fills the weighted mean, and the weighted squares about it over the number of slopes.
template <class Weight> void average(const std::vector<glm::dvec2>& slopes, const Weight& weight, glm::dvec2& mean, Scatter& scatter)
{
    glm::dvec2 sum(0.0);
    double weights = 0.0;
    for (const glm::dvec2& s : slopes) {
        const double w = weight(s);
        sum += s * w, weights += w;
    }
    const glm::dvec2 next = sum / weights;
    Scatter of;
    for (const glm::dvec2& s : slopes) {
        const double w = weight(s);
        const glm::dvec2 d = s - next;
        of.xx += w * d.x * d.x, of.xy += w * d.x * d.y, of.yy += w * d.y * d.y;
    }
    const double n = static_cast<double>(slopes.size());
    mean = next, scatter = with_floor({of.xx / n, of.xy / n, of.yy / n});
}

// Returns the squared distance within which a share of the lobe lies. Distances are relative to the model's widths.
double radius_of(SlopeModel model, double share)
{
    return model == SlopeModel::ggx ? share / (1.0 - share) : -det_log(1.0 - share);
}

// Returns the L1 distance between shares of slopes and equal shares.
template <std::size_t N> double distance_to_even(const std::array<std::size_t, N>& counts, std::size_t slopes)
{
    double sum = 0.0;
    for (const std::size_t count : counts)
        sum += std::abs(static_cast<double>(count) / static_cast<double>(slopes) - 1.0 / N);
    return sum;
}

// The distance along the wide axis alone, in cells that are equally probable under the lobe.
double distance_along(const std::vector<glm::dvec2>& slopes, const SlopeLobe& lobe, SlopeModel model)
{
    constexpr std::size_t kCells = 16;
    const glm::dvec2 axis(det_cos(lobe.angle), det_sin(lobe.angle));
    std::array<std::size_t, kCells> counts = {};
    for (const glm::dvec2& slope : slopes) {
        const double x = glm::dot(slope - lobe.mean, axis) / lobe.alpha_along;
        const double below = model == SlopeModel::ggx ? 0.5 + 0.5 * x / std::sqrt(1.0 + x * x) : 0.5 + 0.5 * std::erf(x);
        ++counts[std::min(kCells - 1, static_cast<std::size_t>(below * kCells))];
    }
    return distance_to_even(counts, slopes.size());
}

double distance_of(const std::vector<glm::dvec2>& slopes, const SlopeLobe& lobe, SlopeModel model)
{
    if (lobe.alpha_across < kSharp)
        return lobe.alpha_along < kSharp ? 0.0 : distance_along(slopes, lobe, model);
    std::array<double, kRings - 1> radii;
    for (int i = 0; i + 1 < kRings; ++i)
        radii[static_cast<std::size_t>(i)] = radius_of(model, static_cast<double>(i + 1) / kRings);
    const double c = det_cos(lobe.angle), s = det_sin(lobe.angle);
    std::array<std::size_t, kSlopeCells> counts = {};
    for (const glm::dvec2& slope : slopes) {
        const glm::dvec2 d = slope - lobe.mean;
        const double x = (c * d.x + s * d.y) / lobe.alpha_along, y = (c * d.y - s * d.x) / lobe.alpha_across;
        const auto ring = std::upper_bound(radii.begin(), radii.end(), x * x + y * y) - radii.begin();
        const int sector = (x < 0.0 ? 4 : 0) + (y < 0.0 ? 2 : 0) + (std::abs(x) < std::abs(y) ? 1 : 0);
        ++counts[static_cast<std::size_t>(8 * ring + sector)];
    }
    return distance_to_even(counts, slopes.size());
}

} // namespace

SlopeLobe fit_slope_lobe(const std::vector<glm::dvec2>& slopes, SlopeModel model)
{
    BN_CHECK(!slopes.empty());
    SlopeLobe lobe;
    Scatter scatter;
    average(
        slopes, [](const glm::dvec2&) { return 1.0; }, lobe.mean, scatter);
    for (int step = 0; model == SlopeModel::ggx && step < kMostSteps; ++step) {
        // A slope with squared distance q weighs (2 + 2) / (2 + q)
        const glm::dvec2 mean = lobe.mean;
        const Scatter before = scatter;
        average(
            slopes, [&](const glm::dvec2& s) { return 4.0 / (2.0 + squared_distance(before, s - mean)); }, lobe.mean, scatter);
        const double change = std::abs(scatter.xx - before.xx) + std::abs(scatter.yy - before.yy) + std::abs(scatter.xy - before.xy);
        if (change < kStepEnd * (scatter.xx + scatter.yy))
            break;
    }
    // Widths along the principal axes: both models have alpha^2 = 2 scatter
    const double half = 0.5 * (scatter.xx - scatter.yy), middle = 0.5 * (scatter.xx + scatter.yy);
    const double reach = std::sqrt(half * half + scatter.xy * scatter.xy);
    lobe.alpha_along = std::sqrt(2.0 * (middle + reach)), lobe.alpha_across = std::sqrt(2.0 * std::max(middle - reach, kLeastScatter));
    lobe.angle = reach > 0.0 ? 0.5 * det_atan2(scatter.xy, half) : 0.0;
    if (lobe.angle < 0.0)
        lobe.angle += kPi;
    lobe.distance = distance_of(slopes, lobe, model);
    return lobe;
}

} // namespace burnish
