#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "core/simd/half.h"
#include "tests/unit/simd/isa_list.h"

namespace burnish {
namespace {

class lane_memory : public OnIsa {
  protected:
    std::mt19937 random_{7};
    float number() { return static_cast<float>(random_() % 20001) * 1e-4f - 1.0f; }
    std::vector<float> numbers(std::size_t n)
    {
        std::vector<float> v(n);
        for (float& x : v)
            x = number();
        return v;
    }
    std::vector<std::int32_t> indices(std::size_t n, std::uint32_t below)
    {
        std::vector<std::int32_t> v(n);
        for (std::int32_t& i : v)
            i = static_cast<std::int32_t>(random_() % below);
        return v;
    }
};

TEST_P(lane_memory, first_lanes_read_zero_and_leave_the_rest_alone)
{
    const int lanes = fns().lanes;
    for (int n = -1; n <= lanes + 3; ++n) {
        const int real_n = std::clamp(n, 0, lanes);
        // Exactly as long as the allowed read, so that a sanitizer sees wider accesses.
        const std::vector<float> from(static_cast<std::size_t>(real_n), 3.0f);
        const std::vector<std::int32_t> from_int(static_cast<std::size_t>(real_n), 5);
        float x[kMaxLanes];
        std::int32_t i[kMaxLanes];
        fns().load_first(from.data(), n, x);
        fns().load_first_int(from_int.data(), n, i);
        for (int k = 0; k < lanes; ++k) {
            EXPECT_EQ(x[k], k < n ? 3.0f : 0.0f);
            EXPECT_EQ(i[k], k < n ? 5 : 0);
        }
        float ones[kMaxLanes], to[kMaxLanes] = {};
        std::int32_t ones_int[kMaxLanes], to_int[kMaxLanes] = {};
        std::fill(ones, ones + kMaxLanes, 1.0f);
        std::fill(ones_int, ones_int + kMaxLanes, 1);
        fns().store_first(to, ones, n);
        fns().store_first_int(to_int, ones_int, n);
        for (int k = 0; k < kMaxLanes; ++k) {
            EXPECT_EQ(to[k], k < real_n ? 1.0f : 0.0f) << "n " << n;
            EXPECT_EQ(to_int[k], k < real_n ? 1 : 0) << "n " << n;
        }
    }
}

TEST_P(lane_memory, masks_and_their_bits_agree)
{
    const std::uint32_t full = (1u << fns().lanes) - 1u;
    for (std::uint32_t bits = 0; bits <= full; ++bits) {
        const std::uint32_t facts = (bits ? 1u << 16 : 0u) | (bits == full ? 1u << 17 : 0u) | (bits ? 0u : 1u << 18);
        ASSERT_EQ(fns().mask_facts(bits), bits | facts);
        ASSERT_EQ(fns().mask_facts(bits | ~full), bits | facts) << "bits beyond the lanes must not matter";
    }
}

TEST_P(lane_memory, compress_keeps_order_and_writes_one_register_at_most)
{
    const std::uint32_t full = (1u << fns().lanes) - 1u;
    std::int32_t x[kMaxLanes];
    for (int k = 0; k < kMaxLanes; ++k)
        x[k] = 100 + k;
    for (std::uint32_t bits = 0; bits <= full; ++bits) {
        std::int32_t to[2 * kMaxLanes] = {}, want[kMaxLanes] = {};
        const std::int32_t untouched[kMaxLanes] = {};
        int count = 0;
        for (int k = 0; k < fns().lanes; ++k)
            if (bits >> k & 1u)
                want[count++] = x[k];
        ASSERT_EQ(fns().compress(to, x, bits), count);
        ASSERT_EQ(std::memcmp(to, want, static_cast<std::size_t>(count) * sizeof *to), 0) << "bits " << bits;
        ASSERT_EQ(std::memcmp(to + fns().lanes, untouched, sizeof untouched), 0) << "bits " << bits;
    }
}

TEST_P(lane_memory, expand_is_the_reverse_of_compress)
{
    const std::uint32_t full = (1u << fns().lanes) - 1u;
    float from[kMaxLanes];
    std::int32_t ints[kMaxLanes];
    for (int k = 0; k < kMaxLanes; ++k)
        from[k] = 0.5f + static_cast<float>(k), ints[k] = 100 + k;
    for (std::uint32_t bits = 0; bits <= full; ++bits) {
        float x[kMaxLanes];
        std::int32_t i[kMaxLanes];
        fns().expand(from, ints, bits, x, i);
        int next = 0;
        for (int k = 0; k < fns().lanes; ++k) {
            const bool on = bits >> k & 1u;
            ASSERT_EQ(x[k], on ? from[next] : 0.0f) << "bits " << bits;
            ASSERT_EQ(i[k], on ? ints[next] : 0) << "bits " << bits;
            next += on;
        }
    }
}

TEST_P(lane_memory, lines_are_copied_past_the_caches)
{
    alignas(64) float from[64], to[64] = {};
    std::iota(from, from + 64, 1.0f);
    fns().stream(to + 16, from, 32);
    for (int i = 0; i < 64; ++i)
        EXPECT_EQ(to[i], i < 16 || i >= 48 ? 0.0f : from[i - 16]) << i;
}

TEST_P(lane_memory, triples_go_to_two_rows_of_eight)
{
    const std::vector<float> r = numbers(kMaxLanes), g = numbers(kMaxLanes), b = numbers(kMaxLanes);
    float first[25] = {}, second[25] = {};
    fns().triples(first, second, r.data(), g.data(), b.data());
    for (int k = 0; k < fns().lanes; ++k) {
        const std::size_t lane = static_cast<std::size_t>(k);
        const float* at = (k < 8 ? first : second) + 3 * (k % 8);
        const float want[3] = {r[lane], g[lane], b[lane]};
        EXPECT_EQ(std::memcmp(at, want, sizeof want), 0) << k;
    }
    const int in_first = fns().lanes < 8 ? fns().lanes : 8, in_second = fns().lanes - in_first;
    EXPECT_EQ(first[3 * in_first], 0.0f); // no further writes
    EXPECT_EQ(second[3 * in_second], 0.0f);
}

TEST_P(lane_memory, gathers_and_tables_read_their_element)
{
    const std::vector<float> reals = numbers(64);
    const std::vector<std::int32_t> ints = indices(64, 1000000);
    for (int round = 0; round < 100; ++round) {
        std::vector<std::int32_t> index = indices(kMaxLanes, 64);
        for (std::int32_t& i : index)
            i -= 32; // indices are signed
        float x[kMaxLanes];
        std::int32_t i[kMaxLanes];
        fns().gather(reals.data() + 32, index.data(), x);
        fns().gather_int(ints.data() + 32, index.data(), i);
        for (int k = 0; k < fns().lanes; ++k) {
            EXPECT_EQ(x[k], reals[static_cast<std::size_t>(index[static_cast<std::size_t>(k)] + 32)]);
            EXPECT_EQ(i[k], ints[static_cast<std::size_t>(index[static_cast<std::size_t>(k)] + 32)]);
        }
        const std::vector<std::int32_t> entry = indices(kMaxLanes, 16);
        fns().table(reals.data(), ints.data(), entry.data(), x, i);
        for (int k = 0; k < fns().lanes; ++k) {
            EXPECT_EQ(x[k], reals[static_cast<std::size_t>(entry[static_cast<std::size_t>(k)])]);
            EXPECT_EQ(i[k], ints[static_cast<std::size_t>(entry[static_cast<std::size_t>(k)])]);
        }
    }
    std::int32_t order[kMaxLanes];
    fns().iota(order);
    for (int k = 0; k < fns().lanes; ++k)
        EXPECT_EQ(order[k], k);
}

TEST_P(lane_memory, reductions_fold_the_upper_half_onto_the_lower)
{
    for (int round = 0; round < 1000; ++round) {
        const std::vector<float> x = numbers(kMaxLanes);
        std::vector<float> sum = x;
        for (int half = fns().lanes / 2; half > 0; half /= 2)
            for (int k = 0; k < half; ++k)
                sum[static_cast<std::size_t>(k)] += sum[static_cast<std::size_t>(k + half)];
        float got[3];
        fns().reduce(x.data(), got);
        EXPECT_EQ(got[0], *std::min_element(x.begin(), x.begin() + fns().lanes));
        EXPECT_EQ(got[1], *std::max_element(x.begin(), x.begin() + fns().lanes));
        EXPECT_EQ(got[2], sum[0]);
    }
}

TEST_P(lane_memory, records_arrive_transposed)
{
    constexpr std::uint32_t kRecords = 300;
    // Offset by 4 bytes: no alignment may be required.
    std::vector<std::uint32_t> words(kRecords * 16 + 1);
    for (std::uint32_t& w : words)
        w = static_cast<std::uint32_t>(random_()); // any bits, including signalling NaN
    for (int round = 0; round < 200; ++round) {
        const std::vector<std::int32_t> index = indices(kMaxLanes, kRecords);
        std::int32_t got[16 * kMaxLanes];
        fns().records(words.data() + 1, index.data(), got);
        for (int k = 0; k < fns().lanes; ++k)
            for (int f = 0; f < 16; ++f)
                ASSERT_EQ(static_cast<std::uint32_t>(got[f * fns().lanes + k]),
                          words[static_cast<std::size_t>(1 + 16 * index[static_cast<std::size_t>(k)] + f)]);
    }
}

TEST_P(lane_memory, records_leave_transposed)
{
    const std::size_t lanes = static_cast<std::size_t>(fns().lanes);
    const std::vector<std::int32_t> fields = indices(16 * lanes, 0x7fffffff);
    std::vector<std::int32_t> words(16 * lanes + 2, -1);
    fns().store_records(words.data() + 1, fields.data()); // offset by 4 bytes
    for (std::size_t k = 0; k < lanes; ++k)
        for (std::size_t f = 0; f < 16; ++f)
            EXPECT_EQ(words[1 + 16 * k + f], fields[f * lanes + k]);
    EXPECT_EQ(words.front(), -1);
    EXPECT_EQ(words.back(), -1);
}

TEST_P(lane_memory, quads_arrive_and_leave_transposed)
{
    constexpr std::uint32_t kQuads = 300;
    const std::size_t lanes = static_cast<std::size_t>(fns().lanes);
    const std::vector<std::int32_t> words = indices(4 * kQuads + 1, 0x7fffffff);
    for (int round = 0; round < 100; ++round) {
        const std::vector<std::int32_t> index = indices(kMaxLanes, kQuads);
        std::vector<std::int32_t> got(4 * lanes);
        fns().quads(words.data() + 1, index.data(), got.data());
        for (std::size_t k = 0; k < lanes; ++k)
            for (std::size_t f = 0; f < 4; ++f)
                ASSERT_EQ(got[f * lanes + k], words[1 + 4 * static_cast<std::size_t>(index[k]) + f]);
    }
    for (int n = 0; n <= fns().lanes; ++n) {
        std::vector<std::int32_t> to(4 * lanes + 1, -1);
        fns().store_quads(to.data(), words.data(), n);
        for (std::size_t i = 0; i < to.size(); ++i)
            EXPECT_EQ(to[i], i < 4 * static_cast<std::size_t>(n) ? words[i % 4 * lanes + i / 4] : -1) << "word " << i << " of " << n;
    }
}

TEST_P(lane_memory, triples_arrive_by_sort)
{
    const std::size_t lanes = static_cast<std::size_t>(fns().lanes);
    const std::vector<std::int32_t> words = indices(3 * lanes + 1, 0x7fffffff);
    std::vector<std::int32_t> got(3 * lanes);
    fns().triples_int(words.data() + 1, got.data());
    for (std::size_t k = 0; k < lanes; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(got[c * lanes + k], words[1 + 3 * k + c]);
}

TEST_P(lane_memory, wide_is_double)
{
    for (int round = 0; round < 100; ++round) {
        const std::vector<std::int32_t> i = indices(kMaxLanes, 1u << 30);
        const std::vector<float> a = numbers(kMaxLanes), b = numbers(kMaxLanes);
        float got[kMaxLanes];
        fns().wide(i.data(), a.data(), b.data(), got);
        for (std::size_t k = 0; k < static_cast<std::size_t>(fns().lanes); ++k) {
            const double n = i[k], quotient = n / static_cast<double>(a[k]), product = static_cast<double>(b[k]) * n;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(got[k]), std::bit_cast<std::uint32_t>(static_cast<float>(quotient - product + 0.1)));
        }
    }
}

TEST_P(lane_memory, blends_round_in_their_stated_order)
{
    constexpr std::uint32_t kRecords = 300;
    const std::vector<float> base = numbers(kRecords * 16);
    for (int round = 0; round < 300; ++round) {
        const std::vector<std::int32_t> i0 = indices(kMaxLanes, kRecords), i1 = indices(kMaxLanes, kRecords),
                                        i2 = indices(kMaxLanes, kRecords);
        const std::vector<float> b0 = numbers(kMaxLanes), b1 = numbers(kMaxLanes), b2 = numbers(kMaxLanes);
        const Blend in{base.data(), i0.data(), i1.data(), i2.data(), b0.data(), b1.data(), b2.data()};
        Blend quad = in;
        quad.base = base.data() + 8; // a field inside the record
        float out16[16 * kMaxLanes], out8[8 * kMaxLanes], out4[4 * kMaxLanes];
        fns().blend16(in, out16);
        fns().blend8(in, out8);
        fns().blend4(quad, out4);
        for (int k = 0; k < fns().lanes; ++k) {
            const std::size_t lane = static_cast<std::size_t>(k);
            const float* r0 = base.data() + 16 * i0[lane];
            const float* r1 = base.data() + 16 * i1[lane];
            const float* r2 = base.data() + 16 * i2[lane];
            for (int f = 0; f < 16; ++f) {
                const float want = (b0[lane] * r0[f] + b1[lane] * r1[f]) + b2[lane] * r2[f];
                ASSERT_EQ(out16[f * fns().lanes + k], want) << "field " << f << " lane " << k;
                if (f < 8) {
                    ASSERT_EQ(out8[f * fns().lanes + k], want) << "field " << f << " lane " << k;
                }
                if (f >= 8 && f < 12) {
                    ASSERT_EQ(out4[(f - 8) * fns().lanes + k], want) << "field " << f << " lane " << k;
                }
            }
        }
    }
}

TEST_P(lane_memory, texels_accumulate_in_their_stated_order)
{
    constexpr std::uint32_t kTexels = 1000;
    constexpr int kSteps = 5;
    std::vector<std::uint16_t> texels(kTexels * 4);
    for (std::size_t t = 0; t < texels.size(); ++t) // a third subnormal, the others finite, both signs
        texels[t] = static_cast<std::uint16_t>((random_() & 0x8000u) | random_() % (t % 3 ? 0x7c00u : 0x400u));
    const std::size_t lanes = static_cast<std::size_t>(fns().lanes), n = kSteps * lanes;
    for (int round = 0; round < 200; ++round) {
        const std::vector<std::int32_t> row0 = indices(n, kTexels - 1), row1 = indices(n, kTexels - 1);
        const std::vector<float> w00 = numbers(n), w10 = numbers(n), w01 = numbers(n), w11 = numbers(n);
        std::vector<float> got(4 * lanes);
        fns().texel({texels.data(), row0.data(), row1.data(), w00.data(), w10.data(), w01.data(), w11.data(), kSteps}, got.data());
        for (std::size_t k = 0; k < lanes; ++k)
            for (std::size_t c = 0; c < 4; ++c) {
                float left = 0.0f, right = 0.0f;
                for (std::size_t s = k; s < n; s += lanes) {
                    const std::uint16_t* t0 = texels.data() + 4 * row0[s] + c;
                    const std::uint16_t* t1 = texels.data() + 4 * row1[s] + c;
                    left = left + (w00[s] * half_to_float(t0[0]) + w01[s] * half_to_float(t1[0]));
                    right = right + (w10[s] * half_to_float(t0[4]) + w11[s] * half_to_float(t1[4]));
                }
                ASSERT_EQ(std::bit_cast<std::uint32_t>(got[c * lanes + k]), std::bit_cast<std::uint32_t>(left + right))
                    << "channel " << c << " lane " << k;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(, lane_memory, testing::ValuesIn(all_isas()), isa_case_name);

} // namespace
} // namespace burnish
