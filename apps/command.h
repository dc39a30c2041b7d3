// A subcommand: its options, and what runs once they are parsed. Each lives in its own cmd_NAME.cpp and has
// its line in commands.def.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace burnish {

struct Command {
    CLI::App* app = nullptr;  // owned by the program's CLI::App
    std::function<int()> run; // returns the exit code
};

#define BN_COMMAND(name) Command add_##name(CLI::App& program);
#include "apps/commands.def"
#undef BN_COMMAND

} // namespace burnish
