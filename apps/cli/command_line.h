// Reads the command line into option values, and prints help.
#pragma once
#include <cstddef>
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

// Returns the index of the first word that asks for help or for the version, or that gives an option to write a file. Else returns the
// number of words.
std::size_t find_output_or_help(const OptionTable& table, const std::vector<std::string>& words);

std::string usage_of(const OptionTable& table); // "[OPTIONS] REFERENCE TEST", "[OPTIONS] [SCENE...]"
std::string help_of(const Command& command);
std::string help_of(const std::vector<Command>& commands, const std::string& footer); // the program itself

} // namespace burnish
