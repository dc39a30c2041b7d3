// A subcommand: its name, its options and its entry function. Each has a file cmd_NAME.cpp and a line in commands.def.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/cli/option.h"

namespace burnish {

struct Command {
    std::string name, summary;
    OptionTable options;
    std::string footer;                   // end of the help: further notes and examples
    std::function<int(OptionTable&)> run; // returns the exit code; empty: burnish-lab runs the subcommand
};

#define BN_COMMAND(name) Command name##_command();
#include "apps/cli/commands.def"

// Returns the subcommands in the order of commands.def.
std::vector<Command> all_commands();

// Gives the program the laboratory's subcommands, in place of their summaries.
void add_lab_commands(std::vector<Command> (*commands)());

} // namespace burnish
