// Special functions, Fresnel's equations and slope covariances in float: equal bits on every instruction set, finite everywhere, close to
// the double oracle.
#include <bit>
#include <cmath>
#include <gtest/gtest.h>

#include "tests/unit/models/float_error.h"
#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

struct Argument {
    double low, high;
    std::vector<double> harsh; // every second value comes from this list
};
const Argument kCosine = {0, 1, {0, 1e-20, 1e-8, 1e-4, 0.5, 0.99999994, 1}};
const Argument kIndex = {0.1, 10, {1e-3, 0.6, 0.99999994, 1, 1.0000001, 1.5, 1e4}};
const Argument kMetal = {0, 10, {0, 1e-3, 0.6, 0.99999994, 1, 1.0000001, 1.5, 1e4}};
const Argument kAbsorption = {0, 10, {0, 1e-20, 1e-8, 1e-3, 1, 1e4}};
const Argument kUnit = {0, 1, {0, 1e-20, 1e-8, 1e-3, 0.5, 1}};
const Argument kEta = {-1, 1, {-1, -0.95, -1e-8, 0, 1e-8, 0.95, 1}};
const Argument kTurn = {-1, 1, {-1, -0.6, -1e-8, 0, 1e-8, 0.8, 1}};
const Argument kVariance = {0, 0.5, {0, 1e-30, 5e-13, 1e-9, 5e-7, 0.125, 0.5}};
const Argument kMixed = {-0.5, 0.5, {-0.5, -1e-5, -1e-25, 0, 1e-25, 1e-9, 0.125}};

enum class Measure { each, together }; // in the last place of each result, or of the point's largest result
struct Function {
    const char* name;
    std::vector<Argument> arguments;
    std::vector<std::size_t> tensors; // first of three arguments xx, yy, xy; xy counts in units of 2 sqrt(xx yy)
    Measure measure;
    Extent bound;     // in multiples of the measure plus sway, twice the observed error
    double low, high; // range of results
};
const std::vector<Function>& functions()
{
    static const std::vector<Function> list = {
        {"exp", {{-86, 88, {-1000, -86.1, -1e-8, 0, 1000}}}, {}, Measure::each, {2, 1}, 0, 1e39},
        {"expm1", {{-86, 88, {-1000, -0.35, -1e-8, 0, 0.35, 1000}}}, {}, Measure::each, {6, 2}, -1, 1e39},
        {"log1p", {{-1, 1e6, {-0.9999999, -0.3, -1e-8, 0, 0.42, 1e30}}}, {}, Measure::each, {3, 2}, -17, 70},
        {"erfinv", {{-0.9999, 0.9999, {-0.9999999, -1e-8, 0, 0.5}}}, {}, Measure::each, {4, 1}, -3.9, 3.9},
        {"fresnel_schlick", {kCosine, kUnit}, {}, Measure::each, {4, 3}, 0, 1},
        {"fresnel_f0", {kIndex}, {}, Measure::each, {6, 3}, 0, 1},
        {"fresnel_dielectric", {kCosine, kIndex}, {}, Measure::each, {16, 11}, 0, 1},
        {"fresnel_conductor", {kCosine, kMetal, kAbsorption}, {}, Measure::each, {52, 15}, 0, 1},
        {"fresnel_conductor3", {kCosine, kMetal, kMetal, kMetal, kAbsorption, kAbsorption, kAbsorption}, {}, Measure::each, {52, 16}, 0, 1},
        {"covariance_tensors",
         {kUnit, kUnit, kTurn, kTurn, kUnit, kUnit, kMixed, kUnit, kUnit, kMixed},
         {4, 7},
         Measure::together,
         {2, 1},
         -8,
         8},
        {"covariance_eta_tensor", {kUnit, kEta, kTurn, kTurn, kUnit, kUnit, kMixed}, {4}, Measure::together, {5, 2}, -8, 8},
        {"covariance_sigmas", {kVariance, kVariance, kMixed}, {0}, Measure::each, {2, 2}, 0, 1},
        {"covariance_axis", {kVariance, kVariance, kMixed}, {0}, Measure::together, {5, 4}, -1, 1},
    };
    return list;
}

constexpr std::size_t kPoints = 40000;

std::vector<double> points(const Function& f)
{
    Random random(61);
    std::vector<double> in;
    for (const Argument& a : f.arguments)
        for (std::size_t k = 0; k < kPoints; ++k) {
            const double x = a.low + (a.high - a.low) * random.next();
            const std::size_t pick = static_cast<std::size_t>(random.next() * static_cast<double>(2 * a.harsh.size()));
            in.push_back(rounded({pick < a.harsh.size() ? a.harsh[pick] : x, 0, 0})[0]);
        }
    for (std::size_t first : f.tensors)
        for (std::size_t k = first * kPoints; k < (first + 1) * kPoints; ++k) {
            double& xy = in[k + 2 * kPoints];
            xy = rounded({2 * xy * std::sqrt(in[k] * in[k + kPoints]), 0, 0})[0];
        }
    return in;
}
std::vector<double> results(const IsaFns& isa, const Function& f, const std::vector<double>& in)
{
    const Kernel& fn = kernel(isa, f.name);
    EXPECT_EQ(static_cast<std::size_t>(fn.inputs), f.arguments.size()) << f.name;
    return run(fn, in);
}

class other_floats : public testing::TestWithParam<Function> {};
void PrintTo(const Function& f, std::ostream* out)
{
    *out << f.name;
}
std::string function_name(const testing::TestParamInfo<Function>& info)
{
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(functions, other_floats, testing::ValuesIn(functions()), function_name);

TEST_P(other_floats, every_instruction_set_gives_the_same_bits)
{
    const std::vector<double> in = points(GetParam()), scalar = results(float_fns()[0], GetParam(), in);
    for (const IsaFns& isa : float_fns()) {
        const std::vector<double> simd = results(isa, GetParam(), in);
        for (std::size_t k = 0; k < scalar.size(); ++k)
            ASSERT_EQ(std::bit_cast<std::uint64_t>(scalar[k]), std::bit_cast<std::uint64_t>(simd[k])) << isa.name << " " << k;
    }
}

TEST_P(other_floats, results_are_finite_and_in_range)
{
    const std::vector<double> in = points(GetParam());
    for (double r : results(float_fns()[0], GetParam(), in))
        ASSERT_TRUE(r >= GetParam().low && r <= GetParam().high) << r; // false for NaN
}

TEST_P(other_floats, stay_close_to_the_double_oracle)
{
    const std::vector<double> in = points(GetParam()), reference = results(oracle_fns(), GetParam(), in),
                              value = results(float_fns()[0], GetParam(), in);
    const std::vector<double> moved = sway(kernel(oracle_fns(), GetParam().name), in);
    Errors errors;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        double size = std::abs(reference[k]);
        for (std::size_t at = k % kPoints; at < reference.size() && GetParam().measure == Measure::together; at += kPoints)
            size = std::max(size, std::abs(reference[at]));
        errors.add(value[k], reference[k], ulp(size), moved[k]);
    }
    errors.expect_within(GetParam().bound, GetParam().name, "value");
}

} // namespace
} // namespace burnish::test
