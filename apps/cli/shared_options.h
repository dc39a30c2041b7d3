// Options common to several subcommands, with one meaning everywhere.
#pragma once
#include <vector>

#include "apps/cli/option.h"
#include "core/base/limits.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {

// `help`: another help text than the default.
Option quiet_option(bool& to);
Option verbose_option(int& to, const char* help = "Print more");
Option threads_option(int& to, const char* help = "Worker threads");
Option isa_option(Isa& to, const char* help = "{}"); // see choose_isa()
std::vector<Option> limit_options(Limits& to);

inline constexpr double kMaxExposure = 64.0; // stops in both directions: 2^64 is far beyond any scene

// Returns the best instruction set, or the requested one if this machine has it.
Result<Isa> choose_isa(const OptionTable& options, Isa asked);

} // namespace burnish
