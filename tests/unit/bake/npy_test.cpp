// Tables as arrays of NumPy.
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>

#include "shading/bake/ltc/npy.h"
#include "shading/bake/ltc/shipped.h"

namespace burnish::ltc {
namespace {

Grid published_grid()
{
    Grid grid;
    grid.beyond = 0, grid.root_alpha = grid.over_alpha = false, grid.basis = Basis::tangent;
    return grid;
}

std::string header_of(const std::string& type = "'<f4'", const std::string& order = "False",
                      const std::string& shape = "(8, 8, 8, 8, 3, 3)")
{
    return fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}", type, order, shape);
}

template <class Number> std::vector<std::uint8_t> file_of(std::string header, const std::vector<Number>& numbers, int version = 1)
{
    header.resize((header.size() + 64) / 64 * 64, ' ');
    header.back() = '\n';
    std::vector<std::uint8_t> bytes = {0x93, 'N', 'U', 'M', 'P', 'Y', static_cast<std::uint8_t>(version), 0};
    for (int k = 0; k < (version == 1 ? 2 : 4); ++k)
        bytes.push_back(static_cast<std::uint8_t>(header.size() >> (8 * k) & 255));
    bytes.insert(bytes.end(), header.begin(), header.end());
    const std::size_t at = bytes.size();
    bytes.resize(at + numbers.size() * sizeof(Number));
    std::memcpy(bytes.data() + at, numbers.data(), numbers.size() * sizeof(Number));
    return bytes;
}

// Returns the built-in lobes as the published files lay them out: alpha, ratio, theta, phi; row by row.
template <class Number> std::vector<Number> published()
{
    const Grid grid = published_grid();
    std::vector<Number> numbers(grid.nodes() * 9);
    for (std::size_t node = 0; node < grid.nodes(); ++node) {
        const auto [theta, phi, alpha, lambda] = grid.indices(node);
        const Matrix m = with_unit_axis(lookup(shipped_table(), grid.place(node)).m);
        const std::size_t stored = static_cast<std::size_t>(((alpha * 8 + lambda) * 8 + theta) * 8 + phi);
        for (std::size_t e = 0; e < 9; ++e)
            numbers[9 * stored + e] = static_cast<Number>(m[e]);
    }
    return numbers;
}

Result<Table> parsed(const std::vector<std::uint8_t>& bytes, int size = 0)
{
    return parse_table(bytes.data(), bytes.size(), "lobes.npy", size);
}

TEST(npy, the_lobes_of_a_file_are_those_at_its_nodes)
{
    for (const auto& bytes : {file_of(header_of(), published<float>()), file_of(header_of("'<f8'"), published<double>(), 2)}) {
        const Result<Table> table = parsed(bytes, 8);
        ASSERT_TRUE(table) << table.error().line();
        const Grid& grid = table->grid;
        EXPECT_EQ(grid.nodes(), 4096u);
        EXPECT_DOUBLE_EQ(grid.alpha_at(1), 1.0 / 7.0);
        for (std::size_t node = 0; node < grid.nodes(); ++node) {
            const Place place = grid.place(node);
            const Looked built_in = lookup(shipped_table(), place);
            const Matrix expected = with_unit_axis(built_in.m);
            const float* const entry = &table->entries[kChannels * node];
            for (std::size_t e = 0; e < 9; ++e)
                ASSERT_NEAR(static_cast<double>(entry[e]), expected[e], 1e-6) << node << " " << e;
            EXPECT_NEAR(static_cast<double>(entry[9]), built_in.all, 1e-6);
            EXPECT_NEAR(static_cast<double>(entry[10]), built_in.grazing, 1e-6);
        }
        EXPECT_TRUE(with_table(*table, "lobes.npy"));
    }
}

TEST(npy, a_mirrored_or_flat_matrix_becomes_usable)
{
    std::vector<float> numbers = published<float>();
    const std::size_t mirrored = 9 * (((3 * 8 + 2) * 8 + 4) * 8 + 5),
                      flat = 9 * (((2 * 8 + 2) * 8 + 4) * 8 + 5); // alpha, ratio, theta, phi
    for (const std::size_t e : {1u, 4u, 7u})
        numbers[mirrored + e] = -numbers[mirrored + e];
    for (const std::size_t e : {0u, 1u, 3u, 4u, 6u, 7u})
        numbers[flat + e] = 0.0f;
    const std::size_t thin = 9 * (((2 * 8 + 2) * 8 + 4) * 8 + 6); // a determinant that floats lose
    for (const std::size_t e : {0u, 1u, 3u, 8u})
        numbers[thin + e] = 1.0f;
    for (const std::size_t e : {2u, 5u, 6u, 7u})
        numbers[thin + e] = 0.0f;
    numbers[thin + 4] = 1.0f;
    const Result<Table> table = parsed(file_of(header_of(), numbers)), whole = parsed(file_of(header_of(), published<float>()));
    ASSERT_TRUE(table && whole);
    const auto entry = [&](const Table& of, int alpha) {
        const float* const at = &of.entries[kChannels * of.grid.node(4, 5, alpha, 2)];
        return std::vector<float>(at, at + kChannels);
    };
    EXPECT_EQ(entry(*table, 3), entry(*whole, 3));
    const Matrix first_order = with_unit_axis(natural_matrix(table->grid.place(table->grid.node(4, 5, 2, 2))));
    for (std::size_t e = 0; e < 9; ++e)
        EXPECT_FLOAT_EQ(entry(*table, 2)[e], static_cast<float>(first_order[e]));
    const std::vector<std::uint8_t> bytes = table_bytes(*table);
    EXPECT_TRUE(parse_table(bytes.data(), bytes.size(), "t", 8));
}

TEST(npy, wrong_files_are_refused_by_their_place)
{
    const std::vector<float> numbers = published<float>();
    const auto place_of = [](const std::vector<std::uint8_t>& bytes, int size = 0) {
        const Result<Table> table = parsed(bytes, size);
        return table ? std::string("none") : table.error().place;
    };
    EXPECT_EQ(place_of(file_of(header_of("'>f4'"), numbers)), "descr");
    EXPECT_EQ(place_of(file_of(header_of("'<i4'"), numbers)), "descr");
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "True"), numbers)), "fortran_order");
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", "(8, 8, 8, 8, 9)"), numbers)), "shape");
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", "(64, 64, 64, 64, 3, 3)"), numbers)), "shape");
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", "("), numbers)), "shape");
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", "(99999999999999999999, 8"), numbers)), "shape");
    EXPECT_EQ(place_of(file_of(header_of(), numbers), 16), "shape");
    EXPECT_EQ(place_of(file_of("", numbers)), "descr");
    for (const char* shape :
         {"(-8, 8, 8, 8, 3, 3)", "(8.8, 8, 8, 3, 3)", "(100000000000000000008, 8, 8, 8, 3, 3)", "(8, 8, 8, 8, 3, 3, 1)", "8"})
        EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", shape), numbers)), "shape") << shape;
    EXPECT_EQ(place_of(file_of(header_of("'<f4'", "False", "(" + std::string(60000, '7')), numbers)), "shape");
    for (const int version : {0, 4}) {
        std::vector<std::uint8_t> other = file_of(header_of(), numbers);
        other[6] = static_cast<std::uint8_t>(version);
        EXPECT_EQ(place_of(other), "byte 6");
    }
    std::vector<std::uint8_t> bytes = file_of(header_of(), numbers);
    EXPECT_EQ(place_of({bytes.begin(), bytes.end() - 1}), fmt::format("byte {}", bytes.size() - 1));
    EXPECT_EQ(place_of({bytes.begin(), bytes.begin() + 9}), "byte 9");
    EXPECT_EQ(place_of({bytes.begin(), bytes.begin() + 40}), "byte 8");
    bytes.push_back(0);
    EXPECT_EQ(place_of(bytes), fmt::format("byte {}", bytes.size() - 1));
    std::vector<float> changed = numbers;
    changed[9 * (7 * 512 + 64 + 8 * 3 + 2) + 4] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(place_of(file_of(header_of(), changed)), "[alpha 7][lambda 1][theta 3][phi 2]");
    changed = numbers; // infinite once the third column is unit
    changed[9 * 100] = 1e30f, changed[9 * 100 + 2] = changed[9 * 100 + 5] = 0.0f, changed[9 * 100 + 8] = 1e-9f;
    EXPECT_NE(place_of(file_of(header_of(), changed)), "none");
    changed = numbers; // by both widths: at the last ratio, the lobe's other width is 1
    for (int alpha = 0; alpha < 8; ++alpha)
        for (std::size_t k = 0; k < 64 * 9; ++k)
            if (k % 9 == 4)
                changed[9 * 64 * static_cast<std::size_t>(8 * alpha + 7) + k] = 2.0f;
    EXPECT_EQ(place_of(file_of(header_of(), changed)), "[alpha 1][lambda 7][theta 0][phi 0]");
    changed = numbers;
    changed[2] = changed[5] = changed[8] = 0.0f;
    EXPECT_EQ(place_of(file_of(header_of(), changed)), "[alpha 0][lambda 0][theta 0][phi 0]");
    for (std::size_t i = 0; i < numbers.size(); i += 9) // seen from the other side
        for (const std::size_t e : {2u, 5u, 6u, 7u})
            changed[i + e] = -numbers[i + e];
    changed[8] = numbers[8];
    const Result<Table> turned = parsed(file_of(header_of(), changed));
    ASSERT_FALSE(turned);
    EXPECT_NE(turned.error().reason.find("lean to the eye"), std::string::npos);
}

} // namespace
} // namespace burnish::ltc
