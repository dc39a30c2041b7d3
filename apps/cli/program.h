// Finds the subcommand, runs it, and maps every outcome to an exit code of core/base/result.h.
#pragma once

namespace burnish {

// Returns the exit code.
int run_program(int argc, char** argv);

} // namespace burnish
