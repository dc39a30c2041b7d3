#include "tests/unit/simd/counted_ops.h"

#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

template <class Work> CountedWork count(const Work& work)
{
    const LaneCounts before = lane_counts;
    const float value = static_cast<float>(work());
    return {lane_counts.operations - before.operations, lane_counts.bytes - before.bytes, value};
}

} // namespace

CountedWork count_dot()
{
    static const float a[3] = {1.0f, 2.0f, 3.0f}, b[3] = {4.0f, 5.0f, 6.0f};
    return count([] {
        return k_dot3(vec3_of(load(a), load(a + 1), load(a + 2)),
                      vec3_of(gather(b, int_lit(0)), gather(b, int_lit(1)), gather(b, int_lit(2))));
    });
}

CountedWork count_root()
{
    return count([] { return sqrt(lit(8.0) / lit(2.0)) - lit(1.0); });
}

CountedWork count_uncounted()
{
    return count([] {
        const real a = -lit(2.5);
        return select(a < lit(0.0), to_real(to_int(a) * int_lit(3)), max(a, lit(1.0)));
    });
}

CountedWork count_texel_add()
{
    static const std::uint16_t texels[16] = {0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00,
                                             0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00, 0x3c00}; // halves of 1
    return count([] {
        const real quarter = lit(0.25);
        const texel_acc acc = texel_add(texel_zero(), texels, int_lit(0), int_lit(2), quarter, quarter, quarter, quarter);
        return acc.left[0];
    });
}

} // namespace BN_ISA_NS
} // namespace burnish
