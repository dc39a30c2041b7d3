// Minimises the sliced Wasserstein distance between samples from a lobe and from a transformed cosine, by Adam (Kingma, Ba 2015). KT,
// Heitz, Dupuy, Narayanan 2022, section 4.2. Samples and axes are lattices, not random.
#include <algorithm>
#include <numeric>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {
namespace {

constexpr int kSteps = 160, kAxes = 12; // axes per step, different in each step
constexpr double kFirstRate = 0.06, kLastRate = 0.002;

struct Projected {
    double at, mass;
    std::size_t sample;
};

// Adds the distance's gradient at every sample of q, along one axis.
void carry(std::vector<Projected>& p, std::vector<Projected>& q, const Vec& axis, std::vector<Vec>& gradient)
{
    const auto less = [](const Projected& a, const Projected& b) { return a.at < b.at; };
    std::sort(p.begin(), p.end(), less);
    std::sort(q.begin(), q.end(), less);
    std::size_t i = 0;
    double left = p.empty() ? 0.0 : p[0].mass;
    for (const Projected& to : q) { // find the mean of the mass carried to this sample
        double open = to.mass, sum = 0.0;
        while (open > 0.0 && i < p.size()) {
            const double part = std::min(open, left);
            sum += part * p[i].at;
            open -= part, left -= part;
            if (!(left > 0.0) && ++i < p.size())
                left = p[i].mass;
        }
        const double off = to.at * (to.mass - open) - sum;
        Vec& g = gradient[to.sample];
        g = {g.x + off * axis.x, g.y + off * axis.y, g.z + off * axis.z};
    }
}

} // namespace

NodeFit fit_sliced(const LobePoints& lobe, const Matrix& start, Mask zero)
{
    Matrix m = with_unit_axis(start);
    std::array<double, 9> mean{}, square{};
    const std::vector<Rule::Point>& cosine = lobe.rule->points;
    std::vector<double> mass; // of the lobe's points, which have another density
    for (const LobePoints::Point& point : lobe.points)
        mass.push_back(point.value.visible > 0.0 ? point.value.reflected / point.value.visible : 0.0);
    const double whole = std::accumulate(mass.begin(), mass.end(), 0.0);
    for (int step = 0; step < kSteps; ++step) {
        // Map the cosine's points to the lobe
        std::vector<Vec> at, gradient(cosine.size(), {0.0, 0.0, 0.0});
        std::vector<double> length;
        for (const Rule::Point& point : cosine) {
            const Vec v = m * point.clamped;
            length.push_back(std::sqrt(dot(v, v)));
            at.push_back(scaled(v, 1.0 / length.back()));
        }
        for (int a = 0; a < kAxes; ++a) { // on the half sphere, by the golden angle
            const double z = (a + 0.5) / kAxes, turn = 2.39996322972865332 * (a + kAxes * step), r = std::sqrt(1.0 - z * z);
            const Vec axis = {r * det_cos(turn), r * det_sin(turn), z};
            std::vector<Projected> p, q;
            for (std::size_t i = 0; i < lobe.points.size(); ++i)
                if (mass[i] > 0.0)
                    p.push_back({dot(axis, lobe.points[i].l), mass[i] / whole, i});
            for (std::size_t i = 0; i < at.size(); ++i)
                q.push_back({dot(axis, at[i]), 1.0 / static_cast<double>(at.size()), i});
            carry(p, q, axis, gradient);
        }
        // Gradient by E in M (I + E): M^T g c^T, where c is the cosine's point and g the desired motion of its image
        std::array<double, 9> slope{};
        for (std::size_t i = 0; i < at.size(); ++i) {
            const double along = dot(gradient[i], at[i]), s = 1.0 / length[i];
            const Vec g = {(gradient[i].x - along * at[i].x) * s, (gradient[i].y - along * at[i].y) * s,
                           (gradient[i].z - along * at[i].z) * s};
            const Vec back = {m[0] * g.x + m[3] * g.y + m[6] * g.z, m[1] * g.x + m[4] * g.y + m[7] * g.z,
                              m[2] * g.x + m[5] * g.y + m[8] * g.z};
            const Vec& c = cosine[i].clamped;
            const double row[3] = {back.x, back.y, back.z}, column[3] = {c.x, c.y, c.z};
            for (std::size_t e = 0; e < 9; ++e)
                slope[e] += row[e / 3] * column[e % 3];
        }
        // Take an Adam step, with a geometric rate
        const double part = step / (kSteps - 1.0), rate = kFirstRate * det_exp(part * det_log(kLastRate / kFirstRate));
        double first = 1.0, second = 1.0; // remaining weight of both means' initial values
        for (int k = 0; k <= step; ++k)
            first *= 0.9, second *= 0.99;
        Matrix turn = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
        for (std::size_t e = 0; e < 9; ++e) {
            mean[e] = 0.9 * mean[e] + 0.1 * slope[e];
            square[e] = 0.99 * square[e] + 0.01 * slope[e] * slope[e];
            const double root = std::sqrt(square[e] / (1.0 - second));
            if (root > 0.0)
                turn[e] -= rate * (mean[e] / (1.0 - first)) / root;
        }
        Matrix next = m * turn;
        for (std::size_t e = 0; e < 9; ++e)
            if (zero >> e & 1u)
                next[e] = 0.0;
        if (determinant(next) > 0.0)
            m = with_unit_axis(next);
    }
    return {m, l1_distance(lobe, m), kSteps};
}

} // namespace burnish::ltc
