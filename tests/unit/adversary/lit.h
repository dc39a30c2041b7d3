// Shared parts of the run-time kernel tests: the shipped table as kernels read it, kernel calls by row, pseudo-random places and
// directions.
#pragma once
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "shading/bake/ltc/table.h"
#include "tests/unit/lanes/kernels.h"

namespace burnish::ltc {

using Row = std::vector<double>; // arguments of a kernel at one point, or its results

std::vector<Row> run_rows(const test::IsaFns& isa, const char* name, const std::vector<Row>& rows, const test::TexelView& t = {});
Row run_row(const test::IsaFns& isa, const char* name, const Row& row, const test::TexelView& t = {});
Row joined(std::initializer_list<Row> rows);
Row rounded(Row row); // to floats, so that double and float versions get equal inputs

const Table& halves();          // the shipped table, rounded to halves
test::TexelView shipped_view(); // its texels
const Table& round_halves();    // the shipped table of round lobes, rounded to halves
test::TexelView round_view();
Row columns(const Matrix& m); // M in the kernels' order
Matrix from_columns(const Row& row);
Row flat(const std::vector<Vec>& points);

constexpr Matrix kCosine = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}; // the clamped cosine itself
Vec along(const Vec& a, double s, const Vec& b, double t, const Vec& c);  // a + s b + t c

struct Chance {
    std::mt19937 bits{1};
    double from(double low, double high);
    Vec point(double size);                               // in a cube around 0
    Vec upper();                                          // unit, above the horizon
    Matrix lobe(double least_alpha, double least_lambda); // from the table, any quadrant
};

} // namespace burnish::ltc
