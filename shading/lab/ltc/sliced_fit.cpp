// Minimises the sliced Wasserstein distance between samples from a lobe and from a transformed cosine. Transport counts by its length (L1).
// Every step draws fresh samples and axes, and follows Adam (Kingma, Ba 2015). KT, Heitz, Dupuy, Narayanan 2022, section 4.2.
#include <algorithm>
#include <array>
#include <random>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/node_fit.h"

namespace burnish::ltc {
namespace {

constexpr int kSteps = 3000, kAxes = 16;
constexpr std::size_t kSamples = 1024; // a step, of each density
constexpr double kFirstRate = 0.03, kLastRate = 0.0003;

class Draws {
  public:
    double number() { return static_cast<double>(bits_() >> 11) * 0x1p-53; } // [0,1)
    Rule::Point point()
    {
        const double u = number(), azimuth = 2.0 * kPi * number(), c = det_cos(azimuth), s = det_sin(azimuth), radius = std::sqrt(u);
        return {u, c, s, {radius * c, radius * s, std::sqrt(1.0 - u)}};
    }
    Vec axis() // on the half sphere
    {
        const double z = number(), azimuth = 2.0 * kPi * number(), radius = std::sqrt(1.0 - z * z);
        return {radius * det_cos(azimuth), radius * det_sin(azimuth), z};
    }

  private:
    std::mt19937_64 bits_{1}; // the standard fixes its numbers
};

double weight_of(const LobePoints::Point& point)
{
    return point.value.visible > 0.0 ? point.value.reflected / point.value.visible : 0.0;
}

// Draws directions with the lobe's density from mirrored visible normals, by rejection. most: the largest weight of these.
void draw_lobe(const Lobe& lobe, double most, Draws& draws, std::vector<Vec>& out)
{
    for (std::size_t i = 0; i < out.size();) {
        const Vec l = mirrored_normal(lobe, draws.point());
        if (l.z > 0.0 && draws.number() * most < weight_of({l, density(lobe, l)}))
            out[i++] = l;
    }
}

// Adds the gradient of the transport along one axis at every sample of q: the direction away from its partner in order.
void add_gradient(const std::vector<Vec>& p, const std::vector<Vec>& q, const Vec& axis, std::vector<Vec>& gradient)
{
    std::array<double, kSamples> lobe;
    std::array<std::pair<double, std::size_t>, kSamples> cosine;
    for (std::size_t i = 0; i < kSamples; ++i)
        lobe[i] = dot(axis, p[i]), cosine[i] = {dot(axis, q[i]), i};
    std::sort(lobe.begin(), lobe.end());
    std::sort(cosine.begin(), cosine.end());
    for (std::size_t i = 0; i < kSamples; ++i) {
        const double way = cosine[i].first < lobe[i] ? -1.0 : cosine[i].first > lobe[i] ? 1.0 : 0.0;
        Vec& g = gradient[cosine[i].second];
        g = {g.x + way * axis.x, g.y + way * axis.y, g.z + way * axis.z};
    }
}

} // namespace

NodeFit fit_sliced(const LobePoints& lobe, const Matrix& start, Mask zero)
{
    Matrix m = with_unit_axis(start);
    std::array<double, 9> mean{}, square{};
    double most = 0.0, first = 1.0, second = 1.0; // first, second: remaining weight of both means' initial values
    for (const LobePoints::Point& point : lobe.points)
        most = std::max(most, weight_of(point));
    Draws draws;
    std::vector<Vec> from(kSamples), cosine(kSamples), at(kSamples), gradient(kSamples);
    std::vector<double> length(kSamples);
    for (int step = 0; step < kSteps; ++step) {
        // Draw samples of both densities
        draw_lobe(lobe.lobe, most, draws, from);
        for (std::size_t i = 0; i < kSamples; ++i) {
            cosine[i] = draws.point().clamped;
            const Vec v = m * cosine[i];
            length[i] = std::sqrt(dot(v, v)), at[i] = scaled(v, 1.0 / length[i]), gradient[i] = {0.0, 0.0, 0.0};
        }
        for (int a = 0; a < kAxes; ++a)
            add_gradient(from, at, draws.axis(), gradient);
        // Find the gradient by E in M (I + E): M^T g c^T, where c is the cosine's sample and g the gradient at its image
        std::array<double, 9> slope{};
        for (std::size_t i = 0; i < kSamples; ++i) {
            const double along = dot(gradient[i], at[i]), s = 1.0 / length[i];
            const Vec g = {(gradient[i].x - along * at[i].x) * s, (gradient[i].y - along * at[i].y) * s,
                           (gradient[i].z - along * at[i].z) * s};
            const double row[3] = {m[0] * g.x + m[3] * g.y + m[6] * g.z, m[1] * g.x + m[4] * g.y + m[7] * g.z,
                                   m[2] * g.x + m[5] * g.y + m[8] * g.z};
            const double column[3] = {cosine[i].x, cosine[i].y, cosine[i].z};
            for (std::size_t e = 0; e < 9; ++e)
                slope[e] += row[e / 3] * column[e % 3];
        }
        // Take an Adam step, with a geometric rate
        const double rate = kFirstRate * det_exp(step / (kSteps - 1.0) * det_log(kLastRate / kFirstRate));
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
