// Options that several subcommands have, which mean the same everywhere.
#pragma once
#include <vector>

#include "apps/cli/option.h"
#include "core/base/limits.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {

// `help`: of more than the usual, where given.
Option quiet_option(bool& to);
Option verbose_option(int& to, const char* help = "Print more");
Option threads_option(int& to, const char* help = "Worker threads");
Option isa_option(Isa& to, const char* help = "{}"); // see choose_isa()
std::vector<Option> limit_options(Limits& to);

inline constexpr double kMaxExposure = 64.0; // stops either way: 2^64 is far beyond any scene

// The best instruction set there is, or the one that was asked for where this machine has it.
Result<Isa> choose_isa(const OptionTable& options, Isa asked);

} // namespace burnish
