// Finds the subcommand, runs it, and turns every outcome into one of the exit codes of core/base/result.h.
#pragma once

namespace burnish {

// Returns the exit code.
int run_program(int argc, char** argv);

} // namespace burnish
