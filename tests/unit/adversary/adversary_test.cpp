// Errors of every kernel's floats against doubles, at the worst inputs found. golden_errors.txt holds the errors and the inputs.
//   BN_ADVERSARY_INPUTS=1e6 unit_adversary_models    another number of random inputs a kernel than 1e5
//   BN_BLESS=1 ...                                   writes the results, one program at a time
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/unit/adversary/domains.h"

namespace burnish::test {
namespace {

constexpr double kInputs = 1e5, kManyInputs = 1e7;
constexpr double kWorse = 4.0; // times the golden error
const char* const kTable = BN_SOURCE_DIR "/tests/unit/adversary/golden_errors.txt";

std::string key_of(const Domain& d, const Judged& j)
{
    return d.kernel + " " + j.name;
}

std::map<std::string, Worst> golden_errors()
{
    std::map<std::string, Worst> rows;
    std::ifstream file(kTable);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kernel, result;
        Worst w;
        if (line.empty() || line[0] == '#' || !(words >> kernel >> result >> w.score >> w.units >> w.absolute))
            continue;
        for (double x; words >> x;)
            w.in.push_back(x);
        rows[kernel + " " + result] = w;
    }
    return rows;
}

void bless(const std::string& key, const Worst& found)
{
    std::map<std::string, Worst> rows = golden_errors();
    rows[key] = found;
    std::ofstream file(kTable);
    file << "# The inputs at which kernels' floats are found furthest from doubles (tests/unit/adversary). Error: in units (the last "
            "place, or\n"
            "# 2^-24 of results that are at most 1) and what a float's step of each input moves the double by; in units alone; itself.\n"
            "# kernel result error units absolute inputs\n";
    for (const auto& [name, w] : rows) {
        char figures[64];
        std::snprintf(figures, sizeof figures, " %.3g %.3g %.3g", w.score, w.units, w.absolute);
        file << name << figures;
        for (const double x : w.in) {
            std::snprintf(figures, sizeof figures, " %.9g", x);
            file << figures;
        }
        file << "\n";
    }
}

class adversaries : public testing::TestWithParam<Domain> {};
std::string kernel_name(const testing::TestParamInfo<Domain>& info)
{
    return info.param.kernel;
}
INSTANTIATE_TEST_SUITE_P(kernels, adversaries, testing::ValuesIn(domains()), kernel_name);

void hold(const Domain& d, double count)
{
    if (const char* asked = std::getenv("BN_ADVERSARY_INPUTS"))
        count = std::atof(asked);
    const std::map<std::string, Worst> table = golden_errors();
    const std::vector<Worst> found = search(d, count, 71);
    for (std::size_t r = 0; r < found.size(); ++r) {
        const std::string key = key_of(d, d.judged[r]);
        Worst worst = found[r];
        const auto row = table.find(key);
        if (row != table.end() && !found[r].in.empty() &&
            row->second.in.size() == found[r].in.size()) { // tests the golden worst input again
            const Worst again = errors_at(d, d.judged[r], row->second.in)[0];
            if (again.score > worst.score)
                worst = again;
        }
        std::printf("%s: %.3g of units and sway, %.3g units, %.3g\n", key.c_str(), worst.score, worst.units, worst.absolute);
        EXPECT_TRUE(std::isfinite(worst.score)) << key << ": floats are no numbers";
        if (std::getenv("BN_BLESS")) {
            bless(key, worst);
            continue;
        }
        ASSERT_NE(row, table.end()) << key << " is not in " << kTable;
        EXPECT_LE(worst.score, kWorse * row->second.score) << key << " at " << testing::PrintToString(worst.in);
    }
}

TEST_P(adversaries, are_no_worse_than_they_were)
{
    hold(GetParam(), kInputs);
}

TEST_P(adversaries, of_ten_million_are_no_worse_than_they_were)
{
    hold(GetParam(), kManyInputs);
}

} // namespace
} // namespace burnish::test
