// Evaluates the double oracle's models at single points, for tests with known values.
#pragma once
#include <gtest/gtest.h>

#include "tests/unit/models/harness.h"

namespace burnish::test {

inline double value(const char* model, bool pdf, const std::vector<double>& params, Vec wo, Vec wi)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, wi);
    const ModelFns fns = fns_of(oracle_fns(), model_case(model));
    return batch.run(pdf ? fns.pdf : fns.eval)[0];
}
inline double eval(const char* model, const std::vector<double>& params, Vec wo, Vec wi)
{
    return value(model, false, params, wo, wi);
}
inline double half_pdf(const char* model, const std::vector<double>& params, Vec wo, Vec wi)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, unit(wo + wi));
    return batch.run(fns_of(oracle_fns(), model_case(model)).half_pdf)[0];
}
struct Sampled {
    Vec wi;
    double weight, pdf, o_dot_h, valid;
};
inline Sampled sample(const char* model, const std::vector<double>& params, Vec wo, double x, double y)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, {x, y, 0});
    const std::vector<double> s = batch.run(fns_of(oracle_fns(), model_case(model)).sample);
    return {{s[0], s[1], s[2]}, s[3], s[4], s[5], s[6]};
}
inline void expect_near(Vec a, Vec b, double tolerance)
{
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}
inline double albedo(const char* model, const Setting& setting, Vec wo, int grid)
{
    Setting padded = setting;
    padded.params.resize(kMaxParams);
    return integral(model_case(model), padded, wo, Integrand::albedo, grid);
}

inline const Vec kUp = {0, 0, 1};
struct Pair {
    Vec v, l;
};
inline const Pair kPairs[] = {{unit({.3, .1, .9}), unit({-.4, .2, .8})}, {kUp, kUp}, {unit({.9, .2, .3}), unit({-.7, -.1, .4})}};

} // namespace burnish::test
