// libFuzzer entry: any text as the sweeps of a chart, one a line.
#include <sstream>
#include <string>

#include "apps/chart/plan.h"
#include "core/base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    std::istringstream lines(std::string(data, data + size));
    Sweeps sweeps;
    for (std::string line; std::getline(lines, line);)
        if (const Status read = parse_sweep(line, sweeps); !read) {
            BN_CHECK(!read.error().reason.empty());
            return 0;
        }
    const std::vector<Setting> settings = settings_of({"bent_normal", "major_axis", "mc"}, sweeps.samples);
    BN_CHECK(settings.size() >= 3);
    for (const Setting& setting : settings)
        BN_CHECK(setting.samples > 0);
    if (cell_count(sweeps) > 10000.0)
        return 0;
    const std::vector<Cell> cells = cells_of(sweeps);
    BN_CHECK(!cells.empty() && static_cast<double>(cells.size()) == cell_count(sweeps));
    for (const Cell& cell : cells)
        BN_CHECK(!describe(cell).empty());
    return 0;
}
