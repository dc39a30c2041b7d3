// Words of the command line to values of options, and help.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/command.h"

namespace burnish {

// Sets all options of `command` that `words` (behind the subcommand) give; of an option given twice the last one counts, unless it
// collects. Fails with the first word that is wrong, else with the first value.
Status read_command_line(Command& command, const std::vector<std::string>& words);
enum class Asked { nothing, help, version };
Asked asked_by(const Command& command, const std::vector<std::string>& words); // -h, --help, --version; not as an option's value

std::string usage_of(const OptionTable& table); // "[OPTIONS] REFERENCE TEST", "[OPTIONS] [SCENE...]"
std::string help_of(const Command& command);
std::string help_of(const std::vector<Command>& commands, const std::string& footer); // of the program itself

} // namespace burnish
