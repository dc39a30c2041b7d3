// Operations that need no instructions of their own: the last include of lanes_scalar.h and lanes_portable.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE integer count_bits4(integer i)
{
    const integer pairs = i - (shr_logical(i, 1) & int_lit(5));
    return (pairs & int_lit(3)) + shr_logical(pairs, 2);
}

BN_INLINE void stream_lines(float* to, const float* from, int n)
{
    __builtin_memcpy(to, from, static_cast<std::size_t>(n) * sizeof(float));
}
BN_INLINE void stream_fence() {}

} // namespace BN_ISA_NS
} // namespace burnish
