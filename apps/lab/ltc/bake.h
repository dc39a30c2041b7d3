// `burnish bake ltc`: makes or measures an LTC table (linearly transformed cosines).
#pragma once
#include "apps/bake/ltc_options.h"

namespace burnish {

int run_ltc(const LtcBake& bake, const OptionTable& given); // returns the exit code; given: the options present on the command line

} // namespace burnish
