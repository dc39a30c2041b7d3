// Values, densities and samples of every model; special functions and reflectances.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/unit/adversary/domains.h"

namespace burnish::test {
namespace {

using Ranges = std::vector<std::vector<double>>;
const std::vector<double> kWidth = {1e-3, 1.0}, kExponent = {1.0, 1e6}, kTilt = {-0.8, 0.8}, kTurn = {-3.1415927, 3.1415927};

const std::map<std::string, Ranges>& parameters()
{
    static const std::map<std::string, Ranges> of = {
        {"lambert", {}},
        {"ggx", {kWidth}},
        {"ggx_aniso", {kWidth, kWidth}},
        {"ggx_aniso_separable", {kWidth, kWidth}},
        {"beckmann", {kWidth, kWidth}},
        {"ward", {kWidth, kWidth}},
        {"ward_cheap", {kWidth, kWidth}},
        {"ashikhmin_shirley", {kExponent, kExponent}},
        {"charlie", {{0.01, 1.0}}},
        {"heidrich_seidel", {{0.0, 1.0}, {0.0, 1.0}, {1.0, 1000.0}}},
        {"ellipsoid", {kWidth, kWidth, kTilt, kTilt, kTurn}},
        {"ellipsoid_correlated", {kWidth, kWidth, kTilt, kTilt, kTurn}},
        {"ellipsoid_dielectric", {kWidth, kWidth, kTilt, kTilt, kTurn, {0.6, 2.0}}},
    };
    return of;
}

// Returns the parameters and the eye from the first numbers. `next` points to the remaining numbers.
std::vector<double> seen(const Domain& d, const double* u, Vec& wo, const double*& next)
{
    std::vector<double> a;
    for (const std::vector<double>& range : d.of)
        a.push_back(in_range(*u++, range));
    a.resize(kMaxParams);
    wo = eye_of(u[0], u[1]);
    append(a, wo);
    next = u + 2;
    return a;
}

std::vector<double> pair(const Domain& d, const double* u)
{
    Vec wo;
    std::vector<double> a = seen(d, u, wo, u);
    const Vec lit = u[0] < 0.7 ? mirrored(wo, facet_of(u[0] / 0.7, u[1])) : eye_of((u[0] - 0.7) / 0.3, u[1]);
    append(a, lit[2] < 0.0 && d.kernel.rfind("ellipsoid_dielectric", 0) != 0 ? lit * -1.0 : lit);
    return a;
}

std::vector<double> half(const Domain& d, const double* u)
{
    Vec wo;
    std::vector<double> a = seen(d, u, wo, u);
    append(a, facet_of(u[0], u[1]));
    return a;
}

std::vector<double> drawn(const Domain& d, const double* u)
{
    Vec wo;
    std::vector<double> a = seen(d, u, wo, u);
    for (const double* x = u; x < u + 3; ++x)
        a.push_back(std::floor(*x * 0x1p24) * 0x1p-24); // multiples of 2^-24, like the random numbers
    return a;
}

std::vector<Domain> all()
{
    const std::vector<Judged> value = {{"value", 0, 1, Unit::last_place}};
    std::vector<Domain> list;
    for (const ModelCase& model : model_cases()) {
        const auto of = parameters().find(model.name);
        if (of == parameters().end())
            continue;
        const int n = static_cast<int>(of->second.size());
        const std::string name = model.name;
        list.push_back({name + "_eval", n + 4, pair, value, -1, nullptr, of->second});
        list.push_back({name + "_pdf", n + 4, pair, value, -1, nullptr, of->second});
        if (model.traits & kHalf)
            list.push_back({name + "_half_pdf", n + 4, half, value, -1, nullptr, of->second});
        list.push_back({name + "_sample",
                        n + 5,
                        drawn,
                        {{"direction", 0, 3, Unit::whole}, {"weight", 3, 1, Unit::last_place}, {"density", 4, 1, Unit::last_place}},
                        6,
                        nullptr,
                        of->second});
    }
    const Ranges unit = {{0.0, 1.0}};
    const auto plain = [&](const char* kernel, const Ranges& of) {
        list.push_back({kernel, static_cast<int>(of.size()), ranges, value, -1, nullptr, of});
    };
    plain("exp", {{-86.0, 88.0}});
    plain("expm1", {{-86.0, 88.0}});
    plain("log1p", {{-0.99999, 1e6}});
    plain("erfinv", {{-0.9999, 0.9999}});
    plain("fresnel_schlick", {{0.0, 1.0}, {0.0, 1.0}});
    plain("fresnel_dielectric", {{0.0, 1.0}, {0.1, 10.0}});
    plain("fresnel_f0", {{0.1, 10.0}});
    plain("fresnel_conductor", {{0.0, 1.0}, {0.01, 10.0}, {0.0, 10.0}});
    return list;
}

TEST(adversaries, every_model_has_a_domain)
{
    for (const ModelCase& model : model_cases())
        EXPECT_EQ(parameters().count(model.name), 1u) << model.name;
}

} // namespace

const std::vector<Domain>& domains()
{
    static const std::vector<Domain> list = all();
    return list;
}

} // namespace burnish::test
