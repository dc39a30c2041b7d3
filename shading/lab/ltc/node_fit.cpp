#include "shading/lab/ltc/node_fit.h"

#include <algorithm>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/levenberg_marquardt.h"

namespace burnish::ltc {
namespace {

constexpr double kSoft = 0.05;    // share of both densities' sum: keeps weights finite where the densities are equal
constexpr double kLongest = 0.4;  // longest step in an element of E
constexpr int kEvaluations = 60;  // most evaluations per fit
constexpr double kSettled = 2e-6; // relative gain per step below which the fit may end

// Adds one point. x: the point in the cosine's space, unit, x.z > 0 where q > 0.
template <bool with_sums, Norm norm> inline void add(Sums& sums, double p, double q, double visible, const Vec& x)
{
    const double weight = 1.0 / (visible + q), r = p - q, apart = std::abs(r);
    sums.l1 += (norm == Norm::l1 ? apart : apart * apart * apart) * weight;
    if constexpr (with_sums) {
        if (!(q > 0.0))
            return;
        const double w = (norm == Norm::l1 ? weight / (apart + kSoft * (p + q)) : weight * apart) * q;
        double g[9] = {1.0 - 4.0 * x.x * x.x,
                       -4.0 * x.x * x.y,
                       -4.0 * x.x * x.z,
                       -4.0 * x.y * x.x,
                       1.0 - 4.0 * x.y * x.y,
                       -4.0 * x.y * x.z,
                       x.x / x.z - 4.0 * x.z * x.x,
                       x.y / x.z - 4.0 * x.z * x.y,
                       2.0 - 4.0 * x.z * x.z};
        const double wr = w * r, wq = w * q;
        double* h = sums.hessian.data();
        for (int i = 0; i < 9; ++i) {
            sums.gradient[static_cast<std::size_t>(i)] += wr * g[i];
            const double s = wq * g[i];
            for (int j = i; j < 9; ++j)
                *h++ += s * g[j];
        }
    }
}

template <bool with_sums, Norm norm = Norm::l1> Sums evaluate(const LobePoints& lobe, const Matrix& m)
{
    Sums sums;
    const Matrix n = inverse(m);
    const double det_m = determinant(m), det_n = std::abs(determinant(n));
    // Points from the visible normals
    for (const LobePoints::Point& point : lobe.points) {
        const Vec u = n * point.l;
        const double length2 = dot(u, u);
        const double q = u.z > 0.0 ? u.z * det_n / (kPi * length2 * length2) : 0.0;
        add<with_sums, norm>(sums, point.value.reflected, q, point.value.visible, scaled(u, 1.0 / std::sqrt(length2)));
    }
    // Points from the transformed cosine
    for (const Rule::Point& point : lobe.rule->points) {
        const Vec w = m * point.clamped;
        const double length = std::sqrt(dot(w, w));
        const double q = point.clamped.z * length * length * length / (kPi * det_m);
        const Reflected f = density(lobe.lobe, scaled(w, 1.0 / length));
        add<with_sums, norm>(sums, f.reflected, q, f.visible, point.clamped);
    }
    const double share = 1.0 / static_cast<double>(lobe.points.size());
    sums.l1 *= share;
    if constexpr (with_sums) {
        for (double& h : sums.hessian)
            h *= share;
        for (double& g : sums.gradient)
            g *= share;
    }
    return sums;
}

// Returns M (I + E)^-1 in the table's scale, with its zeros kept.
Matrix moved(const Matrix& m, const std::array<double, 9>& e, Mask zero)
{
    Matrix turn = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    for (std::size_t i = 0; i < 9; ++i)
        turn[i] += e[i];
    Matrix r = m * inverse(turn);
    for (std::size_t i = 0; i < 9; ++i)
        if (zero >> i & 1u)
            r[i] = 0.0;
    return with_unit_axis(r);
}

} // namespace

LobePoints::LobePoints(const Lobe& of, const Rule& r) : lobe(of), rule(&r)
{
    points.reserve(r.points.size());
    for (const Rule::Point& point : r.points) {
        const Vec l = mirrored_normal(lobe, point);
        points.push_back({l, density(lobe, l)});
    }
}

double l1_distance(const LobePoints& lobe, const Matrix& m)
{
    return evaluate<false>(lobe, m).l1;
}

Sums sums_of(const LobePoints& lobe, const Matrix& m, Norm norm)
{
    return norm == Norm::l3 ? evaluate<true, Norm::l3>(lobe, m) : evaluate<true>(lobe, m);
}

NodeFit fit_lobe(const LobePoints& lobe, const Matrix& start, Mask zero, Norm norm)
{
    NodeFit best = {with_unit_axis(start), 0.0, 1};
    Sums sums = sums_of(lobe, best.m, norm);
    best.l1 = sums.l1;
    double mu = 0.02;
    int settled = 0;
    while (best.evaluations < kEvaluations && mu < 1e4 && settled < 2) {
        std::array<double, 9> e;
        if (!levenberg_marquardt_step(sums.hessian, sums.gradient, mu, zero, e)) {
            mu *= 5.0;
            continue;
        }
        double longest = 0.0;
        for (double v : e)
            longest = std::max(longest, std::abs(v));
        for (double& v : e)
            v *= longest > kLongest ? kLongest / longest : 1.0;
        const Matrix m = moved(best.m, e, zero);
        ++best.evaluations;
        if (!(determinant(m) > 0.0)) {
            mu *= 5.0;
            continue;
        }
        const Sums next = sums_of(lobe, m, norm);
        if (next.l1 < best.l1) {
            settled = best.l1 - next.l1 < kSettled * best.l1 ? settled + 1 : 0;
            best.m = m, best.l1 = next.l1, sums = next;
            mu = std::max(mu / 3.0, 1e-5);
        } else {
            mu *= 4.0;
        }
    }
    return best;
}

} // namespace burnish::ltc
