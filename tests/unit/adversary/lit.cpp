#include "tests/unit/adversary/lit.h"

#include <gtest/gtest.h>

namespace burnish::ltc {

std::vector<Row> run_rows(const test::IsaFns& isa, const char* name, const std::vector<Row>& rows, const test::TexelView& t)
{
    const std::size_t n = rows.size(), inputs = rows[0].size();
    std::vector<double> in(n * inputs);
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < inputs; ++i)
            in[i * n + k] = rows[k][i];
    EXPECT_EQ(static_cast<int>(inputs), test::kernel(isa, name).inputs) << name;
    const std::vector<double> out = test::call(isa, name, in, t);
    std::vector<Row> results(n, Row(out.size() / n));
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < results[k].size(); ++i)
            results[k][i] = out[i * n + k];
    return results;
}

Row run_row(const test::IsaFns& isa, const char* name, const Row& row, const test::TexelView& t)
{
    return run_rows(isa, name, {row}, t)[0];
}

Row joined(std::initializer_list<Row> rows)
{
    Row all;
    for (const Row& row : rows)
        all.insert(all.end(), row.begin(), row.end());
    return all;
}

Row rounded(Row row)
{
    for (double& x : row)
        x = static_cast<double>(static_cast<float>(x));
    return row;
}

namespace {

Table as_halves(const char* name, int size)
{
    const std::string path = std::string(BN_SOURCE_DIR) + "/shading/bake/ltc/" + name;
    const Result<Table> whole = read_table(path, size);
    EXPECT_TRUE(whole) << (whole ? "" : whole.error().line());
    const std::vector<std::uint8_t> bytes = table_bytes(*whole, true);
    return *parse_table(bytes.data(), bytes.size(), path, size);
}

} // namespace

const Table& halves()
{
    static const Table table = as_halves("ggx.ltc", kShadingSize);
    return table;
}

const Table& round_halves()
{
    static const Table table = as_halves("ggx_round.ltc", kShadingRoundSize);
    return table;
}

test::TexelView round_view()
{
    static const std::vector<std::uint16_t> texels = table_texels(round_halves());
    test::TexelView t;
    t.texels = texels.data();
    return t;
}

test::TexelView shipped_view()
{
    static const std::vector<std::uint16_t> texels = table_texels(halves());
    test::TexelView t;
    t.texels = texels.data();
    t.level = static_cast<int>(halves().grid.basis) + 4 * halves().grid.over_alpha, t.levels = halves().grid.sizes()[2];
    return t;
}

Row columns(const Matrix& m)
{
    return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

Matrix from_columns(const Row& r)
{
    return {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
}

Row flat(const std::vector<Vec>& points)
{
    Row row;
    for (const Vec& p : points)
        row.insert(row.end(), {p.x, p.y, p.z});
    return row;
}

double Chance::from(double low, double high)
{
    return low + (high - low) * (static_cast<double>(bits()) / 4294967296.0);
}

Vec Chance::point(double size)
{
    const double x = from(-size, size), y = from(-size, size);
    return {x, y, from(-size, size)};
}

Vec Chance::upper()
{
    const double z = from(0.03, 0.999), turn = from(-3.14159, 3.14159), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

Matrix Chance::lobe(double least_alpha, double least_lambda)
{
    const Vec eye = upper();
    const double u = from(0.0, 1.0), alpha = least_alpha * std::pow(1.0 / least_alpha, u), other = alpha * from(least_lambda, 1.0);
    const bool swap = from(0.0, 1.0) < 0.5;
    return from_columns(
        run_row(test::oracle_fns(), "ltc_lookup", {eye.x, eye.y, eye.z, swap ? other : alpha, swap ? alpha : other}, shipped_view()));
}

Vec along(const Vec& a, double s, const Vec& b, double t, const Vec& c)
{
    return {a.x + s * b.x + t * c.x, a.y + s * b.y + t * c.y, a.z + s * b.z + t * c.z};
}

} // namespace burnish::ltc
