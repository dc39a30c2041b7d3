// libFuzzer entry: any text as a chart's cached rows. Rows that were read are written and read again, unchanged.
#include <string>

#include "apps/chart/rows.h"
#include "core/base/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    const Result<ChartResults> kept = parse_chart_results(std::string(data, data + size), "fuzz");
    if (!kept) {
        BN_CHECK(!kept.error().reason.empty());
        return 0;
    }
    const std::string text = chart_results_json(*kept);
    const Result<ChartResults> again = parse_chart_results(text, "fuzz");
    BN_CHECK(again && chart_results_json(*again) == text);
    return 0;
}
