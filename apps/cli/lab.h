// The laboratory's subcommands, in a separate program, burnish-lab, beside this one.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Replaces this process by burnish-lab with these words. If burnish-lab cannot start, prints a line on standard error and returns
// ExitCode::unavailable.
int start_lab(const std::vector<std::string>& words);

} // namespace burnish
