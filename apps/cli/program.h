// Finds the subcommand, runs it, and maps every outcome to an exit code of core/base/result.h.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Returns the exit code.
int run_program(int argc, char** argv);
// Runs a subcommand, given as its words. Exceptions pass.
int run_words(const std::vector<std::string>& words);

} // namespace burnish
