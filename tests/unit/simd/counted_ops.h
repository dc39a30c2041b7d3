// Pieces of kernels with known work, for the counting lanes.
#pragma once
#include <cstdint>

namespace burnish {

struct CountedWork {
    std::uint64_t operations, bytes;
    float value; // result of the calculation
};
inline namespace bn_counted {
CountedWork count_dot();       // (1, 2, 3) . (4, 5, 6), loaded from memory
CountedWork count_root();      // sqrt(a / b) - 1 with a = 8, b = 2
CountedWork count_uncounted(); // negation, comparison, selection, conversion, integers
CountedWork count_texel_add(); // one bilinear footprint
} // namespace bn_counted

} // namespace burnish
