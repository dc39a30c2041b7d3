// `burnish chart --mip`: measures mip filters, not frames.
#pragma once
#include "apps/chart/options.h"

namespace burnish {

int run_mip_chart(const ChartArguments& arguments, const OptionTable& given); // returns the exit code

} // namespace burnish
