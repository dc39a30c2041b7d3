// A subcommand: its options, and what runs once they are parsed. Each lives in its own cmd_NAME.cpp and has
// its line in commands.def.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace burnish {

struct Command {
    CLI::App* app = nullptr;  // owned by the program's CLI::App
    std::function<int()> run; // returns the exit code
};

#define BN_COMMAND(name) Command add_##name(CLI::App& program);
#include "apps/commands.def"
#undef BN_COMMAND

// Every option of `app` that takes a value wants one that is not empty. Call it once all options are there.
inline void refuse_empty_values(CLI::App& app)
{
    const CLI::Validator not_empty(
        [](std::string& text) { return text.empty() ? std::string("the value is empty") : std::string(); }, "");
    for (CLI::Option* option : app.get_options())
        if (option->get_items_expected_max() > 0)
            option->check(not_empty);
}

} // namespace burnish
