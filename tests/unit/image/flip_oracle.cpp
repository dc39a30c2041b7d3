#include "flip_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burnish::test {
namespace {

using Vec = std::array<double, 3>;
const double kPiHere = std::acos(-1.0);

struct Plane {
    int width, height;
    std::vector<double> v;
    double at(int x, int y) const
    {
        return v[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
    }
};

struct Kernel {
    int radius;
    std::vector<double> w;
    double at(int x, int y) const { return w[static_cast<std::size_t>((y + radius) * (2 * radius + 1) + x + radius)]; }
};

template <class F> Kernel make_kernel(int radius, const F& f)
{
    Kernel k{radius, {}};
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            k.w.push_back(f(x, y));
    return k;
}

// Scales positive weights to the sum 1 and negative weights to the sum -1.
Kernel normalised(Kernel k)
{
    double positive = 0, negative = 0;
    for (const double w : k.w)
        (w > 0 ? positive : negative) += std::fabs(w);
    for (double& w : k.w)
        w /= w > 0 ? positive : negative;
    return k;
}

double convolve(const Plane& p, const Kernel& k, int x, int y)
{
    double sum = 0;
    for (int j = -k.radius; j <= k.radius; ++j)
        for (int i = -k.radius; i <= k.radius; ++i)
            sum += k.at(i, j) * p.at(x + i, y + j);
    return sum;
}

const Vec kWhite = {0.950428545, 1.0, 1.088900371};

Vec xyz_of(const Vec& c)
{
    return {(10135552 * c[0] + 8788810 * c[1] + 4435075 * c[2]) / 24577794, (2613072 * c[0] + 8788810 * c[1] + 887015 * c[2]) / 12288897,
            (1425312 * c[0] + 8788810 * c[1] + 70074185 * c[2]) / 73733382};
}

Vec rgb_of(const Vec& c)
{
    return {3.241003275 * c[0] - 1.537398934 * c[1] - 0.498615861 * c[2], -0.969224334 * c[0] + 1.875930071 * c[1] + 0.041554224 * c[2],
            0.055639423 * c[0] - 0.204011202 * c[1] + 1.057148933 * c[2]};
}

Vec hunt_lab(const Vec& rgb)
{
    Vec f = xyz_of(rgb);
    for (std::size_t c = 0; c < 3; ++c) {
        const double t = f[c] / kWhite[c], d = 6.0 / 29;
        f[c] = t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    }
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double hyab(const Vec& a, const Vec& b)
{
    return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

struct Seen {
    std::array<Plane, 3> ycxcz;
    Plane luminance;
};

Seen see(const Image& image)
{
    const Plane empty{image.width, image.height, {}};
    Seen seen{{empty, empty, empty}, empty};
    for (std::size_t i = 0; i < image.bytes.size() / 4; i += 3) {
        Vec rgb;
        for (std::size_t c = 0; c < 3; ++c)
            rgb[c] = static_cast<double>(image.f32()[i + c]);
        Vec n = xyz_of(rgb);
        for (std::size_t c = 0; c < 3; ++c)
            n[c] /= kWhite[c];
        seen.luminance.v.push_back(n[1]);
        const Vec out = {116 * n[1] - 16, 500 * (n[0] - n[1]), 200 * (n[1] - n[2])};
        for (std::size_t c = 0; c < 3; ++c)
            seen.ycxcz[c].v.push_back(out[c]);
    }
    return seen;
}

Vec filtered_lab(const Seen& seen, const std::array<Kernel, 3>& csf, int x, int y)
{
    const double yy = (convolve(seen.ycxcz[0], csf[0], x, y) + 16) / 116;
    const double cx = convolve(seen.ycxcz[1], csf[1], x, y) / 500, cz = convolve(seen.ycxcz[2], csf[2], x, y) / 200;
    Vec rgb = rgb_of({(yy + cx) * kWhite[0], yy * kWhite[1], (yy - cz) * kWhite[2]});
    for (double& v : rgb)
        v = std::clamp(v, 0.0, 1.0);
    return hunt_lab(rgb);
}

} // namespace

std::vector<double> flip_by_definition(const Image& reference, const Image& test, double ppd)
{
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPiHere * kPiHere)) * ppd));
    const auto gaussian = [&](double a, double b, int x, int y) {
        return a * kPiHere / b * std::exp(-kPiHere * kPiHere * (x * x + y * y) / (ppd * ppd) / b) / std::sqrt(kPiHere / b);
    };
    const std::array<Kernel, 3> csf = {
        normalised(make_kernel(radius, [&](int x, int y) { return gaussian(1, 0.0047, x, y); })),
        normalised(make_kernel(radius, [&](int x, int y) { return gaussian(1, 0.0053, x, y); })),
        normalised(make_kernel(radius, [&](int x, int y) { return gaussian(34.1, 0.04, x, y) + gaussian(13.5, 0.025, x, y); }))};
    const double sd = 0.5 * 0.082 * ppd;
    const int feature = static_cast<int>(std::ceil(3 * sd));
    const auto bell = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2 * sd * sd)); };
    const auto bend = [&](int x, int y) { return (x * x / (sd * sd) - 1) * bell(x, y); };
    const Kernel edge_x = normalised(make_kernel(feature, [&](int x, int y) { return -x * bell(x, y); }));
    const Kernel edge_y = normalised(make_kernel(feature, [&](int x, int y) { return -y * bell(x, y); }));
    const Kernel point_x = normalised(make_kernel(feature, bend));
    const Kernel point_y = normalised(make_kernel(feature, [&](int x, int y) { return bend(y, x); }));

    const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    const Seen a = see(reference), b = see(test);
    std::vector<double> errors;
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x) {
            const double d = std::pow(hyab(filtered_lab(a, csf, x, y), filtered_lab(b, csf, x, y)), 0.7);
            const double knee = 0.4 * largest;
            const double colour = d < knee ? d * 0.95 / knee : 0.95 + (d - knee) / (largest - knee) * 0.05;
            const auto strength = [&](const Plane& p, const Kernel& kx, const Kernel& ky) {
                return std::hypot(convolve(p, kx, x, y), convolve(p, ky, x, y));
            };
            const double edges = std::fabs(strength(a.luminance, edge_x, edge_y) - strength(b.luminance, edge_x, edge_y));
            const double points = std::fabs(strength(a.luminance, point_x, point_y) - strength(b.luminance, point_x, point_y));
            errors.push_back(std::pow(colour, 1 - std::sqrt(std::max(edges, points) / std::sqrt(2.0))));
        }
    return errors;
}

} // namespace burnish::test
