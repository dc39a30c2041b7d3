// A subcommand: what it is called, its options, and what runs once they are read. Each lives in its own cmd_NAME.cpp and has its line in
// commands.def.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/cli/option.h"

namespace burnish {

struct Command {
    std::string name, summary;
    OptionTable options;
    std::string footer;                   // of the help: what else is worth knowing, and examples
    std::function<int(OptionTable&)> run; // returns the exit code
};

#define BN_COMMAND(name) Command name##_command();
#include "apps/cli/commands.def"
#undef BN_COMMAND

std::vector<Command> all_commands(); // in the order of commands.def

} // namespace burnish
