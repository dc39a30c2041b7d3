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
    std::function<int(OptionTable&)> run; // returns the exit code; empty: the laboratory's program runs it
};

#define BN_COMMAND(name) Command name##_command();
#include "apps/cli/commands.def"

// Returns the subcommands in the order of commands.def.
std::vector<Command> all_commands();

// Gives the program subcommands of the laboratory, in place of their summaries.
void add_lab_commands(std::vector<Command> (*commands)());

} // namespace burnish
