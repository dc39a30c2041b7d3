// The shipped table: symmetries, quality, and refused files.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "shading/lab/ltc/bake_ltc.h"
#include "shading/lab/ltc/quality.h"

namespace burnish::ltc {
namespace {

const Table& shipped()
{
    static const Table table = [] {
        const Result<Table> read = read_table(std::string(BN_SOURCE_DIR) + "/shading/bake/ltc/ggx.ltc", 8);
        EXPECT_TRUE(read) << (read ? "" : read.error().line());
        return read ? *read : Table{};
    }();
    return table;
}

Matrix entry(const Table& t, std::size_t node)
{
    Matrix m;
    for (std::size_t e = 0; e < 9; ++e)
        m[e] = static_cast<double>(t.entries[kChannels * node + e]);
    return m;
}

TEST(table, seen_along_the_normal_all_azimuths_are_one)
{
    const Table& t = shipped();
    for (int phi = 1; phi < 8; ++phi)
        for (int alpha = 0; alpha < t.grid.sizes()[2]; ++alpha)
            for (int lambda = 0; lambda < 8; ++lambda)
                EXPECT_EQ(std::memcmp(&t.entries[kChannels * t.grid.node(0, phi, alpha, lambda)],
                                      &t.entries[kChannels * t.grid.node(0, 0, alpha, lambda)], kChannels * sizeof(float)),
                          0)
                    << phi << alpha << lambda;
}

TEST(table, in_planes_of_symmetry_what_must_be_zero_is)
{
    const Table& t = shipped();
    for (std::size_t node = 0; node < t.grid.nodes(); ++node)
        for (std::size_t e = 0; e < 9; ++e)
            if (t.grid.zero(node) >> e & 1u) {
                EXPECT_EQ(t.entries[kChannels * node + e], 0.0f) << node << " " << e;
            }
}

TEST(table, round_lobes_are_the_same_from_both_sides_of_the_diagonal)
{
    const Table& t = shipped();
    for (int theta = 0; theta < 8; ++theta)
        for (int phi = 0; phi < 8; ++phi)
            for (int alpha = 0; alpha < t.grid.sizes()[2]; ++alpha) {
                const Matrix a = entry(t, t.grid.node(theta, phi, alpha, 7)),
                             b = with_axes_exchanged(entry(t, t.grid.node(theta, 7 - phi, alpha, 7)));
                for (std::size_t e = 0; e < 9; ++e)
                    EXPECT_EQ(a[e], b[e]) << theta << phi << alpha << " " << e;
            }
}

TEST(table, a_lobe_mirrored_is_the_matrix_with_rows_negated)
{
    // Four quadrants and swapped axes, against lobes seen from there.
    const Rule rule(15), white(18);
    const Place place = {0.9, 0.6, 0.4, 0.3};
    const Matrix m = lookup(shipped(), place).m;
    const Lobe lobe = normalised_lobe(place, white);
    const auto distance = [&rule](const Lobe& of, Matrix by) {
        if (determinant(by) < 0.0) // a positive determinant gives equal density
            by[1] = -by[1], by[4] = -by[4], by[7] = -by[7];
        return l1_distance(LobePoints(of, rule), by);
    };
    const double alone = distance(lobe, m);
    EXPECT_LT(alone, 0.3);
    const Matrix swap = {0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    for (const auto& [x, y] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
        const Matrix flip = {x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 1.0};
        Lobe mirrored = lobe;
        mirrored.v = flip * lobe.v;
        Lobe swapped = mirrored;
        swapped.v = swap * mirrored.v;
        std::swap(swapped.alpha_x, swapped.alpha_y);
        EXPECT_NEAR(distance(mirrored, flip * m), alone, 0.01) << x << y;
        EXPECT_NEAR(distance(swapped, swap * (flip * m)), alone, 0.01) << x << y;
        EXPECT_GT(distance(swapped, flip * m), alone + 0.3) << x << y;
        if (x < 0.0 || y < 0.0) {
            EXPECT_GT(distance(mirrored, m), alone + 0.3) << x << y;
        }
    }
}

TEST(table, every_lookup_has_a_positive_determinant)
{
    const Jobs jobs(1);
    EXPECT_EQ(broken_lookups(shipped(), 100000, jobs), 0u);
}

TEST(table, lobes_are_as_near_as_was_measured)
{
    const Jobs jobs(1);
    std::vector<double> l1, relative, absolute, all;
    for (const Judged& j : judge(shipped(), judged_places(40, 0, 0), 0, jobs)) {
        l1.push_back(j.l1), all.push_back(j.all_relative);
        relative.insert(relative.end(), j.light_relative, j.light_relative + kLights);
        absolute.insert(absolute.end(), j.light_absolute, j.light_absolute + kLights);
    }
    EXPECT_LT(spread_of(l1).mean, 0.16);
    EXPECT_LT(spread_of(relative).mean, 0.08);
    EXPECT_LT(spread_of(absolute).mean, 0.008);
    EXPECT_LT(spread_of(all).mean, 0.01);
}

// Covers places where guarded determinants could spoil whole cells for lookups at their corners.
TEST(table, near_the_horizon_lobes_are_as_near_as_was_measured)
{
    std::vector<double> l1, best;
    for (const Judged& j : judge(shipped(), grazing_places(120), 1, Jobs()))
        l1.push_back(j.l1), best.push_back(j.best_l1);
    const Spread off = spread_of(l1), least = spread_of(best);
    printf("mean %.4f, p95 %.4f, most %.4f; of own fits %.4f, %.4f, %.4f\n", off.mean, off.p95, off.most, least.mean, least.p95,
           least.most);
    EXPECT_LT(off.mean, 1.06 * least.mean);
    EXPECT_LT(off.most, least.most + 0.15);
}

TEST(table, halves_change_next_to_nothing)
{
    const std::vector<std::uint8_t> bytes = table_bytes(shipped(), true);
    const Result<Table> halves = parse_table(bytes.data(), bytes.size(), "halves", 8);
    ASSERT_TRUE(halves) << halves.error().line();
    EXPECT_EQ(bytes.size(), 32u + 64u * 11u * 8u * 11u * 2u + 8u);
    const Jobs jobs(1);
    const std::vector<Place> places = judged_places(20, 0, 0);
    const std::vector<Judged> a = judge(shipped(), places, 0, jobs), b = judge(*halves, places, 0, jobs);
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_NEAR(a[i].l1, b[i].l1, 0.002);
}

TEST(table, bytes_survive_the_way_there_and_back)
{
    const std::vector<std::uint8_t> bytes = table_bytes(shipped());
    const Result<Table> read = parse_table(bytes.data(), bytes.size(), "t", 0);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->entries, shipped().entries);
    EXPECT_EQ(table_bytes(*read), bytes);
}

// Changes bytes and seals them again, as a faulty writer would.
std::string refusal(const std::function<void(std::vector<std::uint8_t>&)>& change, bool sealed, int size = 8)
{
    std::vector<std::uint8_t> bytes = table_bytes(shipped());
    change(bytes);
    if (sealed) {
        const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size() - 8);
        std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
    }
    const Result<Table> read = parse_table(bytes.data(), bytes.size(), "t.ltc", size);
    if (read)
        return "";
    EXPECT_EQ(read.error().code, ExitCode::bad_input);
    return read.error().line();
}

std::function<void(std::vector<std::uint8_t>&)> with_entry(std::size_t node, std::size_t channel, float value)
{
    return [=](std::vector<std::uint8_t>& b) { std::memcpy(b.data() + 32 + 4 * (kChannels * node + channel), &value, 4); };
}

TEST(table, what_is_wrong_is_named)
{
    using Bytes = std::vector<std::uint8_t>;
    const auto names = [](const std::string& line, const char* what) { return line.find(what) != std::string::npos; };
    EXPECT_EQ(refusal([](Bytes&) {}, true), "");
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[0] = 'x'; }, true), "not a table"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b.resize(10); }, false), "not a table"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[8] = 9; }, true), "version 9"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b.resize(b.size() - 100); }, false), "bytes, which must be"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b.push_back(0); }, false), "bytes, which must be"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[1000] ^= 1; }, false), "damaged"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[12] = 200; }, true), "200 nodes"));
    EXPECT_TRUE(names(refusal([](Bytes&) {}, true, 12), "12 are asked for"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[18] = 1; }, true), "flags"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[20] = 12; }, true), "channels"));
    EXPECT_TRUE(names(refusal([](Bytes& b) { b[24] = 9; }, true), "beyond 1"));
    const Grid grid;
    const std::size_t node = grid.node(3, 2, 5, 1);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const std::string line = refusal(with_entry(node, 10, bad), true);
        EXPECT_TRUE(names(line, "[theta 3][phi 2][alpha 5][lambda 1]") && names(line, "channel 10")) << line;
    }
    const float turned = -shipped().entries[kChannels * node + 4];
    EXPECT_TRUE(names(refusal(with_entry(node, 4, turned), true), "[theta 3][phi 2][alpha 5][lambda 1]: has no positive determinant"));
}

} // namespace
} // namespace burnish::ltc
