// Builds the filters in double with portable functions, so that their bits are equal on every machine.
#include "core/image/metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/scalar_math.h"

namespace burnish {
namespace {

// Contrast sensitivity as Gaussians over degrees, a sqrt(pi/b) exp(-pi^2 x^2 / b): Andersson et al. 2020, table 1.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity kAchromatic{1.0, 0.0047}, kRedGreen{1.0, 0.0053};
constexpr Sensitivity kBlueYellow{34.1, 0.04}, kBlueYellow2{13.5, 0.025};

// Width of the feature detectors in degrees: w = 0.082. Half the width is the standard deviation.
constexpr double kFeatureWidth = 0.082;

// Smallest tap relative to the central one. Smaller taps do not change a float result.
constexpr double kNoTap = 1e-9;

using Half = std::vector<double>; // [k] at distance k from the centre

Half gaussian(const Sensitivity& s, double factor, int radius, double ppd)
{
    Half half;
    for (int k = 0; k <= radius; ++k) {
        const double x = k / ppd;
        half.push_back(factor * det_exp(-kPi * kPi * x * x / s.b));
    }
    return half;
}

double whole_sum(const Half& half)
{
    double sum = 0.0;
    for (std::size_t k = half.size(); k-- > 1;)
        sum += 2.0 * half[k];
    return sum + half[0];
}

void scale(Half& half, double factor)
{
    for (double& w : half)
        w *= factor;
}

int significant_radius(const Half& half)
{
    int radius = static_cast<int>(half.size()) - 1;
    while (radius > 0 && half[static_cast<std::size_t>(radius)] < kNoTap * half[0])
        --radius;
    return radius;
}

// Converts to a column, with zeros beyond the half kernel's own radius.
Column<float> column_of(const Half& half, int radius)
{
    Column<float> column(static_cast<std::size_t>(radius) + 1);
    for (std::size_t k = 0; k < std::min(half.size(), column.size()); ++k)
        column[k] = static_cast<float>(half[k]);
    return column;
}

// Hunt-adjusted L*a*b* of a saturated primary in XYZ relative to white. Both primaries are bright enough for the cubic
// branch of L*a*b* in every channel but one.
struct Lab {
    double l, a, b;
};
Lab adjusted(double x, double y, double z)
{
    const auto f = [](double t) {
        constexpr double kDelta = 6.0 / 29.0;
        return t > kDelta * kDelta * kDelta ? det_pow(t, 1.0 / 3.0) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    };
    const double l = 116.0 * f(y) - 16.0;
    return {l, 0.01 * l * 500.0 * (f(x) - f(y)), 0.01 * l * 200.0 * (f(y) - f(z))};
}

// Returns the HyAB distance between pure green and pure blue to the power 0.7.
double largest_difference()
{
    const double white_x = 0.950428545, white_z = 1.088900371; // as in flip.isa.cpp
    const Lab green = adjusted(8788810.0 / 24577794.0 / white_x, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0 / white_z);
    const Lab blue = adjusted(4435075.0 / 24577794.0 / white_x, 887015.0 / 12288897.0, 70074185.0 / 73733382.0 / white_z);
    const double a = green.a - blue.a, b = green.b - blue.b;
    return det_pow(std::fabs(green.l - blue.l) + std::sqrt(a * a + b * b), 0.7);
}

} // namespace

FlipKernels::FlipKernels(double ppd)
{
    make_features(ppd);
    make_spatial(ppd);
    radius_ = std::max({lanes_.y_radius, lanes_.cx_radius, lanes_.cz_radius});
    lanes_.y = y_.data(), lanes_.cx = cx_.data(), lanes_.cz = cz_.data(), lanes_.cz2 = cz2_.data();
    lanes_.gauss = gauss_.data(), lanes_.edge = edge_.data(), lanes_.point = point_.data();
    lanes_.max_difference = static_cast<float>(largest_difference());
}

// Makes the contrast-sensitivity kernels, which reach three standard deviations of the widest Gaussian. The kernels of
// Y and Cx each sum to 1. The two terms of Cz sum to 1 together, in two dimensions: (sum of one)^2 + (sum of the
// other)^2 = 1. Each term holds the square root of its two-dimensional factor.
void FlipKernels::make_spatial(double ppd)
{
    const double widest = std::max({kAchromatic.b, kRedGreen.b, kBlueYellow.b, kBlueYellow2.b});
    const int reach = static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPi * kPi)) * ppd));
    Half y = gaussian(kAchromatic, 1.0, reach, ppd), cx = gaussian(kRedGreen, 1.0, reach, ppd);
    scale(y, 1.0 / whole_sum(y));
    scale(cx, 1.0 / whole_sum(cx));
    const auto factor = [](const Sensitivity& s) { return std::sqrt(s.a * std::sqrt(kPi / s.b)); };
    Half cz = gaussian(kBlueYellow, factor(kBlueYellow), reach, ppd);
    Half cz2 = gaussian(kBlueYellow2, factor(kBlueYellow2), reach, ppd);
    const double one = whole_sum(cz), other = whole_sum(cz2);
    const double norm = 1.0 / std::sqrt(one * one + other * other);
    scale(cz, norm);
    scale(cz2, norm);

    lanes_.y_radius = std::max(lanes_.y_radius, significant_radius(y));
    lanes_.cx_radius = significant_radius(cx);
    lanes_.cz_radius = reach;
    y_ = column_of(y, lanes_.y_radius);
    cx_ = column_of(cx, lanes_.cx_radius);
    cz_ = column_of(cz, reach);
    cz2_ = column_of(cz2, reach);
    for (Column<float>* feature : {&gauss_, &edge_, &point_})
        feature->resize(static_cast<std::size_t>(lanes_.y_radius) + 1);
}

// Makes a Gaussian that sums to 1 and its derivatives, whose positive and negative taps sum to 1 and -1.
void FlipKernels::make_features(double ppd)
{
    const double deviation = 0.5 * kFeatureWidth * ppd;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    Half gauss, edge, point;
    double edge_sum = 0.0, positive = 0.0, negative = 0.0;
    for (int k = 0; k <= radius; ++k) {
        const double x2 = static_cast<double>(k) * k / (deviation * deviation);
        const double g = det_exp(-0.5 * x2), twice = k == 0 ? 1.0 : 2.0;
        gauss.push_back(g);
        edge.push_back(k * g);
        point.push_back((x2 - 1.0) * g);
        edge_sum += edge.back();
        (point.back() > 0.0 ? positive : negative) += twice * std::fabs(point.back());
    }
    scale(gauss, 1.0 / whole_sum(gauss));
    scale(edge, 1.0 / edge_sum);
    for (double& w : point)
        w /= w > 0.0 ? positive : negative;
    lanes_.y_radius = radius;
    gauss_ = column_of(gauss, radius);
    edge_ = column_of(edge, radius);
    point_ = column_of(point, radius);
}

} // namespace burnish
