#include "shading/lab/ltc/pair_fit.h"

#include <algorithm>
#include <array>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/levenberg_marquardt.h"

namespace burnish::ltc {
namespace {

constexpr std::size_t kUnknowns = 19; // E of both, and the share
constexpr double kPairSoft = 0.05;    // as for one lobe
constexpr double kLongestPairStep = 0.3;
constexpr double kLeastShare = 0.02;
constexpr int kPairEvaluations = 60; // per start

struct PairSums {
    double l1 = 0.0;
    std::array<double, kUnknowns*(kUnknowns + 1) / 2> hessian{}; // upper triangle by rows
    std::array<double, kUnknowns> gradient{};
};

// Writes the derivatives of log q by E. x: the point in the cosine's space, unit.
void log_slopes(const Vec& x, double factor, double* g)
{
    const double at[3] = {x.x, x.y, x.z};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            g[3 * i + j] = factor * ((i == j ? 1.0 : 0.0) + (i == 2 ? at[j] / x.z : 0.0) - 4.0 * at[i] * at[j]);
}

PairSums pair_sums(const LobePoints& lobe, const PairFit& pair, bool with_sums)
{
    PairSums sums;
    const Matrix n[2] = {inverse(pair.m[0]), inverse(pair.m[1])};
    const double share[2] = {pair.share, 1.0 - pair.share};
    const auto add = [&](const Vec& l, const Reflected& f, double part) {
        double q[2], g[kUnknowns] = {};
        for (std::size_t k = 0; k < 2; ++k) {
            q[k] = transformed_cosine(n[k], l);
            if (with_sums && q[k] > 0.0)
                log_slopes(unit(n[k] * l), share[k] * q[k], g + 9 * k);
        }
        const double both = share[0] * q[0] + share[1] * q[1], r = f.reflected - both, apart = std::abs(r);
        if (!(f.visible + both > 0.0))
            return;
        const double weight = part / (f.visible + both);
        sums.l1 += weight * apart;
        if (!with_sums || !(both > 0.0))
            return;
        g[18] = q[0] - q[1];
        const double w = weight / (apart + kPairSoft * (f.reflected + both));
        double* h = sums.hessian.data();
        for (std::size_t i = 0; i < kUnknowns; ++i) {
            sums.gradient[i] += w * r * g[i];
            for (std::size_t j = i; j < kUnknowns; ++j)
                *h++ += w * g[i] * g[j];
        }
    };
    const double each = 1.0 / static_cast<double>(lobe.points.size());
    for (const LobePoints::Point& point : lobe.points)
        add(point.l, point.value, each);
    for (std::size_t k = 0; k < 2; ++k)
        for (const Rule::Point& point : lobe.rule->points) {
            const Vec l = unit(pair.m[k] * point.clamped);
            add(l, density(lobe.lobe, l), each * share[k]);
        }
    return sums;
}

PairFit moved_pair(const PairFit& pair, const std::array<double, kUnknowns>& by)
{
    PairFit to = pair;
    double longest = 0.0;
    for (double v : by)
        longest = std::max(longest, std::abs(v));
    const double s = longest > kLongestPairStep ? kLongestPairStep / longest : 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
        Matrix turn = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
        for (std::size_t e = 0; e < 9; ++e)
            turn[e] += s * by[9 * k + e];
        to.m[k] = with_unit_axis(pair.m[k] * inverse(turn));
    }
    to.share = std::clamp(pair.share + s * by[18], kLeastShare, 1.0 - kLeastShare);
    return to;
}

PairFit fit_from(const LobePoints& lobe, const PairFit& start)
{
    PairFit best = start;
    PairSums sums = pair_sums(lobe, best, true);
    best.l1 = sums.l1, best.evaluations = 1;
    double mu = 0.02;
    while (best.evaluations < kPairEvaluations && mu < 1e3) {
        std::array<double, kUnknowns> by;
        if (!levenberg_marquardt_step(sums.hessian, sums.gradient, mu, 0, by)) {
            mu *= 5.0;
            continue;
        }
        PairFit next = moved_pair(best, by);
        ++best.evaluations;
        if (determinant(next.m[0]) > 0.0 && determinant(next.m[1]) > 0.0) {
            const PairSums there = pair_sums(lobe, next, true);
            if (there.l1 < best.l1) {
                next.l1 = there.l1, next.evaluations = best.evaluations;
                best = next, sums = there;
                mu = std::max(mu / 3.0, 1e-5);
                continue;
            }
        }
        mu *= 4.0;
    }
    return best;
}

} // namespace

double l1_of_pair(const LobePoints& lobe, const PairFit& pair)
{
    return pair_sums(lobe, pair, false).l1;
}

PairFit fit_pair(const LobePoints& lobe, const Matrix& single)
{
    struct Split {
        double narrow, x, y; // factor for the first one's widths; how far the axes lean apart, in columns
    };
    constexpr Split kSplits[] = {{0.6, 0.0, 0.0}, {1.0, 0.5, 0.0}, {1.0, 0.0, 0.5}};
    PairFit best{};
    int evaluations = 0;
    for (const Split& split : kSplits) {
        PairFit start{};
        start.share = 0.5;
        for (std::size_t k = 0; k < 2; ++k) {
            const double sign = k ? -1.0 : 1.0, width = k ? 1.0 / split.narrow : split.narrow;
            start.m[k] = with_unit_axis(single * Matrix{width, 0.0, sign * split.x, 0.0, width, sign * split.y, 0.0, 0.0, 1.0});
        }
        const PairFit fit = fit_from(lobe, start);
        evaluations += fit.evaluations;
        if (best.evaluations == 0 || fit.l1 < best.l1)
            best = fit;
    }
    best.evaluations = evaluations;
    return best;
}

} // namespace burnish::ltc
