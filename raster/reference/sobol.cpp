#include "raster/reference/sobol.h"

namespace burnish {
namespace {

// Primitive polynomials and initial direction numbers for dimensions 2 to 5 (dimension 1 is van der Corput's): Joe and Kuo 2008,
// "Constructing Sobol sequences with better two-dimensional projections", set new-joe-kuo-6.
struct Direction {
    int degree;
    std::uint32_t polynomial; // inner coefficients, as a binary number
    std::uint32_t initial[3];
};
constexpr Direction kDirections[kSobolDimensions - 1] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}};
constexpr int kBits = 6; // 64 points

SobolTable make_table()
{
    SobolTable t = {};
    for (int d = 0; d < kSobolDimensions; ++d) {
        std::uint32_t m[kBits];
        for (int k = 0; k < kBits; ++k) {
            m[k] = 1;
            if (d == 0)
                continue;
            const Direction& from = kDirections[d - 1];
            if (k < from.degree) {
                m[k] = from.initial[k];
                continue;
            }
            m[k] = m[k - from.degree] ^ (m[k - from.degree] << from.degree);
            for (int j = 1; j < from.degree; ++j)
                if (from.polynomial >> (from.degree - 1 - j) & 1u)
                    m[k] ^= m[k - j] << j;
        }
        for (int i = 0; i < kPassSamples; ++i) {
            std::uint32_t x = 0, reversed = 0;
            for (int k = 0; k < kBits; ++k)
                if (i >> k & 1)
                    x ^= m[k] << (31 - k);
            for (int b = 0; b < 32; ++b)
                reversed |= (x >> b & 1u) << (31 - b);
            t.points[d][i] = reversed;
        }
    }
    return t;
}

} // namespace

const SobolTable& sobol_table()
{
    static const SobolTable table = make_table();
    return table;
}

} // namespace burnish
