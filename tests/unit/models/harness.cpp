#include "tests/unit/models/harness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace burnish::test {

ModelFns fns_of(const IsaFns& isa, const ModelCase& model)
{
    const auto of = [&](const char* what) -> const Kernel& { return kernel(isa, (model.name + std::string(what)).c_str()); };
    return {of("_eval"), of("_pdf"), of("_half_pdf"), of("_sample")};
}

Vec operator+(Vec a, Vec b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator*(Vec a, double s)
{
    return {a[0] * s, a[1] * s, a[2] * s};
}
double dot(Vec a, Vec b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec unit(Vec a)
{
    const double length = std::sqrt(dot(a, a));
    return length > 0 ? a * (1 / length) : a;
}
Vec direction(double theta, double phi)
{
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
// volatile: GCC 12.2 -O3 removes two neighbouring conversions to float and back.
Vec rounded(Vec a)
{
    for (double& x : a) {
        const volatile float narrow = static_cast<float>(x);
        x = static_cast<double>(narrow);
    }
    return a;
}

const std::vector<ModelCase>& model_cases()
{
    static const std::vector<ModelCase> all = [] {
        std::vector<ModelCase> list;
#define BN_SETTINGS(...) __VA_ARGS__
#define BN_MODEL(id, summary, params, laws, settings) list.push_back({#id, laws, {BN_SETTINGS settings}});
#include "shading/models.def"
        for (ModelCase& model : list)
            for (Setting& setting : model.settings)
                setting.params.resize(kMaxParams);
        return list;
    }();
    return all;
}

const ModelCase& model_case(const std::string& name)
{
    const ModelCase* found = nullptr;
    for (const ModelCase& model : model_cases())
        if (name == model.name)
            found = &model;
    BN_CHECK(found != nullptr);
    return *found;
}

double Random::next()
{
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return static_cast<double>(z >> 40) * 0x1p-24;
}

Vec Random::hemisphere()
{
    const double z = next();
    const double phi = 2 * std::numbers::pi * next();
    const double s = std::sqrt(1 - z * z);
    return rounded({s * std::cos(phi), s * std::sin(phi), z});
}

Batch::Batch(const std::vector<double>& params, std::size_t count) : n(count), in(count * kModelInputs)
{
    for (std::size_t i = 0; i < kMaxParams; ++i)
        for (std::size_t k = 0; k < n; ++k)
            in[i * n + k] = params[i];
}

void Batch::set(std::size_t k, Vec wo, Vec other_vec)
{
    for (std::size_t i = 0; i < 3; ++i) {
        in[(kMaxParams + i) * n + k] = wo[i];
        in[(kMaxParams + 3 + i) * n + k] = other_vec[i];
    }
}

Vec Batch::wo(std::size_t k) const
{
    return {in[kMaxParams * n + k], in[(kMaxParams + 1) * n + k], in[(kMaxParams + 2) * n + k]};
}

std::vector<double> Batch::run(const Kernel& kernel) const
{
    return test::run(kernel, in);
}

Chart chart_of(const ModelCase& model, const Setting& setting, Vec wo)
{
    const double steepest = (model.traits & kBothSides) != 0 ? std::numbers::pi : std::numbers::pi / 2;
    return {wo, (model.traits & kHalf) != 0, steepest, setting.widths};
}

Chart::Point Chart::at(double u, double v) const
{
    const double phi = 2 * std::numbers::pi * v;
    Point p{};
    if (!half) {
        p.wi = direction(steepest * u, phi);
        p.per_wi = 2 * std::numbers::pi * steepest * std::sin(steepest * u);
        return p;
    }
    const double rest = (1 - u) * (1 - u); // finer where the lobe is thin, since grazing views magnify it
    const double t2 = (1 - rest) / rest;
    const double t = std::sqrt(t2);
    p.h = unit({widths[0] * t * std::cos(phi), widths[1] * t * std::sin(phi), 1});
    const double z3 = p.h[2] * p.h[2] * p.h[2];
    p.per_h = 2 * (1 - u) * std::numbers::pi * widths[0] * widths[1] * z3 * (1 + t2) * (1 + t2);
    const double o_dot_h = dot(wo, p.h);
    p.wi = p.h * (2 * o_dot_h) + wo * -1;
    p.per_wi = o_dot_h > 0 && p.wi[2] > 0 ? 4 * o_dot_h * p.per_h : 0;
    return p;
}

std::array<double, 2> Chart::of(Vec wi) const
{
    double x = wi[0], y = wi[1], u = std::acos(std::clamp(wi[2], -1.0, 1.0)) / steepest;
    if (half) {
        const Vec h = unit(wo + wi);
        x = h[0] / widths[0], y = h[1] / widths[1];
        const double t2 = (x * x + y * y) / (h[2] * h[2]);
        u = 1 - std::sqrt(1 / (1 + t2));
    }
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    return {u, turn < 0 ? turn + 1 : turn};
}

double integral(const ModelCase& model, const Setting& setting, Vec wo, Integrand what, int grid)
{
    const Chart chart = chart_of(model, setting, wo);
    const std::size_t n = static_cast<std::size_t>(grid);
    Batch batch(setting.params, n * n);
    std::vector<double> measure(n * n);
    for (std::size_t k = 0; k < n * n; ++k) {
        const double u = (static_cast<double>(k / n) + 0.5) / grid;
        const double v = (static_cast<double>(k % n) + 0.5) / grid;
        const Chart::Point p = chart.at(u, v);
        batch.set(k, wo, what == Integrand::half_pdf ? p.h : p.wi);
        measure[k] = what == Integrand::half_pdf ? p.per_h : p.per_wi;
        if (what == Integrand::albedo)
            measure[k] *= std::abs(p.wi[2]);
    }
    const ModelFns& fns = fns_of(fast_fns(), model);
    const std::vector<double> f = batch.run(what == Integrand::albedo ? fns.eval : what == Integrand::pdf ? fns.pdf : fns.half_pdf);
    double sum = 0;
    for (std::size_t k = 0; k < n * n; ++k)
        sum += measure[k] > 0 ? f[k] * measure[k] : 0;
    return sum / static_cast<double>(n * n);
}

std::vector<Vec> views(const ModelCase& model)
{
    std::vector<Vec> list;
    const double angles[][2] = {{0, 0}, {0.35, 0.4}, {0.8, 2.0}, {1.2, -1.1}, {1.45, 0.3}};
    for (const auto& a : angles) {
        const Vec wo = rounded(direction(a[0], a[1]));
        list.push_back(wo);
        if ((model.traits & kBothSides) != 0)
            list.push_back(wo * -1);
    }
    return list;
}

} // namespace burnish::test
