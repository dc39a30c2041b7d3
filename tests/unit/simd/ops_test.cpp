#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/unit/simd/isa_list.h"

namespace burnish {
namespace {

struct Columns {
    std::vector<float> a, b, c;
    std::vector<std::int32_t> i, j;
    OpInput input() const { return {a.data(), b.data(), c.data(), i.data(), j.data(), static_cast<int>(a.size())}; }
};

const std::vector<std::uint32_t>& special_bits()
{
    static const std::vector<std::uint32_t> bits = {
        0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000, 0x80800000, 0x3f800000, 0xbf800000,
        0x3f7fffff, 0x3f000000, 0xbf000000, 0x3fc00000, 0x40200000, 0xc0200000, 0x4affffff, 0x4b000001, 0x4e800000,
        0x4f000000, 0xcf000000, 0xcf000001, 0x4effffff, 0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000,
        0xffc00000, 0x7f800001, 0xff812345, 0x7fffffff, 0x40490fdb, 0x42fe0000, 0xc2fc0000, 0x0da24260, 0x7149f2ca};
    return bits;
}

// Returns every pair of special values, random bits, and ordinary numbers.
Columns make_columns()
{
    Columns columns;
    std::mt19937 random(20240601);
    const auto bits_at = [](std::size_t k) { return special_bits()[k % special_bits().size()]; };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t i, std::uint32_t j) {
        columns.a.push_back(std::bit_cast<float>(a));
        columns.b.push_back(std::bit_cast<float>(b));
        columns.c.push_back(std::bit_cast<float>(c));
        columns.i.push_back(static_cast<std::int32_t>(i));
        columns.j.push_back(static_cast<std::int32_t>(j));
    };
    for (std::size_t x = 0; x < special_bits().size(); ++x)
        for (std::size_t y = 0; y < special_bits().size(); ++y)
            add(bits_at(x), bits_at(y), bits_at(x + 5 * y), bits_at(x), bits_at(y));
    const auto word = [&] { return static_cast<std::uint32_t>(random()); };
    const auto number = [&] { return std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<std::int32_t>(random())) * 0x1p-28f); };
    for (int k = 0; k < 20000; ++k) {
        const std::uint32_t a = word(), b = word(), c = word(), i = word(), j = word();
        add(a, b, c, i, j);
    }
    for (int k = 0; k < 20000; ++k) {
        const std::uint32_t a = number(), b = number(), c = number(), i = word() % 2000, j = word() % 2000;
        add(a, b, c, i, j);
    }
    while (columns.a.size() % kMaxLanes)
        add(0, 0, 0, 0, 0);
    return columns;
}

bool is_nan(std::uint32_t bits)
{
    return (bits & 0x7fffffffu) > 0x7f800000u;
}

class lane_ops : public OnIsa {};

TEST_P(lane_ops, equal_scalar_bit_for_bit)
{
    const LaneFns& scalar = pick<LaneFns>(Isa::scalar);
    const LaneFns& wide = fns();
    ASSERT_EQ(scalar.op_count, wide.op_count);
    const Columns columns = make_columns();
    const OpInput in = columns.input();
    std::vector<std::uint32_t> want(columns.a.size()), got(columns.a.size());
    for (int op = 0; op < scalar.op_count; ++op) {
        scalar.ops[op].run(in, want.data());
        wide.ops[op].run(in, got.data());
        int shown = 0;
        for (std::size_t k = 0; k < want.size() && shown < 3; ++k) {
            if (want[k] == got[k] || (scalar.ops[op].any_nan && is_nan(want[k]) && is_nan(got[k])))
                continue;
            ++shown;
            ADD_FAILURE() << scalar.ops[op].name << std::hex << " a " << std::bit_cast<std::uint32_t>(in.a[k]) << " b "
                          << std::bit_cast<std::uint32_t>(in.b[k]) << " c " << std::bit_cast<std::uint32_t>(in.c[k]) << " i " << in.i[k]
                          << " j " << in.j[k] << ": scalar " << want[k] << ", wide " << got[k];
        }
    }
}

// Checks the scalar lanes against definitions that do not use them.
TEST(scalar_ops, mean_what_they_say)
{
    const Columns columns = make_columns();
    const OpInput in = columns.input();
    const LaneFns& scalar = pick<LaneFns>(Isa::scalar);
    std::vector<std::uint32_t> out(columns.a.size());
    const auto check = [&](const char* name, auto expected) {
        for (int op = 0; op < scalar.op_count; ++op) {
            if (std::string(scalar.ops[op].name) != name)
                continue;
            scalar.ops[op].run(in, out.data());
            for (std::size_t k = 0; k < out.size(); ++k)
                ASSERT_EQ(out[k], static_cast<std::uint32_t>(expected(k))) << name << " at " << k;
            return;
        }
        ADD_FAILURE() << "no op " << name;
    };
    const auto truncated = [](double x) { // the result of cvttps2dq
        return !(x > -2147483649.0 && x < 2147483648.0) ? std::numeric_limits<std::int32_t>::min() : static_cast<std::int32_t>(x);
    };
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    check("to_int", [&](std::size_t k) { return truncated(static_cast<double>(in.a[k])); });
    check("round_to_int", [&](std::size_t k) { return truncated(std::nearbyint(static_cast<double>(in.a[k]))); });
    check("min_real", [&](std::size_t k) { return bits(in.a[k] < in.b[k] ? in.a[k] : in.b[k]); });
    check("max_real", [&](std::size_t k) { return bits(in.a[k] > in.b[k] ? in.a[k] : in.b[k]); });
    check("abs", [&](std::size_t k) { return bits(in.a[k]) & 0x7fffffffu; });
    check("negate", [&](std::size_t k) { return bits(in.a[k]) ^ 0x80000000u; });
    check("int_multiply", [&](std::size_t k) { return static_cast<std::uint32_t>(in.i[k]) * static_cast<std::uint32_t>(in.j[k]); });
    check("shl_7", [&](std::size_t k) { return static_cast<std::uint32_t>(in.i[k]) << 7; });
    check("shr_1", [&](std::size_t k) { return static_cast<std::int32_t>(std::floor(0.5 * in.i[k])); });
    check("shr_logical_1", [&](std::size_t k) { return static_cast<std::uint32_t>(in.i[k]) / 2; });
    check("count_bits4",
          [&](std::size_t k) { return static_cast<std::uint32_t>(__builtin_popcount(static_cast<unsigned>(in.i[k]) & 15u)); });
    check("select_mask", [&](std::size_t k) { return in.i[k] & 1 ? (in.j[k] & 2) != 0 : in.a[k] < in.b[k]; });
    check("lit", [&](std::size_t) { return bits(0.1f); });
    check("multiply_add", [&](std::size_t k) { // rounds twice
        const volatile float product = in.a[k] * in.b[k];
        const float sum = product + in.c[k];
        return std::isnan(sum) ? out[k] : bits(sum);
    });
}

INSTANTIATE_TEST_SUITE_P(, lane_ops, testing::ValuesIn(all_isas()), isa_case_name);

} // namespace
} // namespace burnish
