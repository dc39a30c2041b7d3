// Subcommands of the laboratory: a program of its own, burnish-lab, beside this one.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Runs burnish-lab in place of this program, with these words. Returns only where it cannot be started: ExitCode::unavailable, after a line
// on standard error.
int start_lab(const std::vector<std::string>& words);

} // namespace burnish
