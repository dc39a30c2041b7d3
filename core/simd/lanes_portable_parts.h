// Operations as loops over lanes, for lanes_portable.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

BN_CALL std::uint32_t to_bits(const mask& m)
{
    const int_lanes on = lanes_of(m);
    std::uint32_t bits = 0;
    BN_EACH_LANE bits |= (static_cast<std::uint32_t>(on.at[k]) & 1u) << k;
    return bits;
}
BN_CALL mask mask_from_bits(std::uint32_t bits)
{
    int_lanes on;
    BN_EACH_LANE on.at[k] = (bits >> k & 1u) != 0 ? -1 : 0;
    return __builtin_bit_cast(mask, on);
}
BN_OP bool any(const mask& m)
{
    return to_bits(m) != 0;
}
BN_OP bool all(const mask& m)
{
    return to_bits(m) == (1u << kLanes) - 1u;
}
BN_OP bool none(const mask& m)
{
    return to_bits(m) == 0;
}

BN_OP real min(const real& a, const real& b)
{
    return select(a < b, a, b);
}
BN_OP real max(const real& a, const real& b)
{
    return select(a > b, a, b);
}
#define BN_BY_LANE(name, function)                                                                                                         \
    BN_CALL real name(const real& x)                                                                                                       \
    {                                                                                                                                      \
        float_lanes r = lanes_of(x);                                                                                                       \
        BN_EACH_LANE r.at[k] = function(r.at[k]);                                                                                          \
        return real_of(r);                                                                                                                 \
    }
BN_BY_LANE(sqrt, __builtin_sqrtf)
BN_BY_LANE(floor, __builtin_floorf)
BN_BY_LANE(ceil, __builtin_ceilf)
BN_BY_LANE(round_to_even, __builtin_rintf)
#undef BN_BY_LANE

BN_CALL integer to_int(const real& x)
{
    const mask inside = both(x >= splat(-0x1p31f), x < splat(0x1p31f));
    const real safe = select(inside, x, splat(0.0f));
    integer r;
    BN_EACH_PART r.p[p] = __builtin_convertvector(safe.p[p], part_i);
    return select(inside, r, int_lit(INT32_MIN));
}
BN_OP integer round_to_int(const real& x)
{
    return to_int(round_to_even(x));
}

} // namespace BN_ISA_NS
} // namespace burnish
