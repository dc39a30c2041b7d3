// Reads the command line into option values, and prints help.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/command.h"

namespace burnish {

// Sets all options of `command` that occur in `words` (after the subcommand). For a repeated option the last value counts, unless the
// option
// collects values. Fails with the first wrong word, else with the first wrong value.
Status read_command_line(Command& command, const std::vector<std::string>& words);
enum class Asked { nothing, help, version };
Asked asked_by(const Command& command, const std::vector<std::string>& words); // -h, --help, --version; skips values of options

std::string usage_of(const OptionTable& table); // "[OPTIONS] REFERENCE TEST", "[OPTIONS] [SCENE...]"
std::string help_of(const Command& command);
std::string help_of(const std::vector<Command>& commands, const std::string& footer); // the program itself

} // namespace burnish
