// `burnish manual`: prints the manual page, the completions and the reference pages.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/lab.h"
#include "apps/cli/manual.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"

namespace burnish {

namespace {
std::vector<Command> (*lab_commands)() = nullptr;
}

void add_lab_commands(std::vector<Command> (*commands)())
{
    lab_commands = commands;
}

std::vector<Command> all_commands()
{
    std::vector<Command> commands;
#define BN_COMMAND(name) commands.push_back(name##_command());
#define BN_LAB_COMMAND(name, summary) commands.push_back({#name, summary, {}, {}, {}});
#include "apps/cli/commands.def"
    if (lab_commands)
        for (Command& own : lab_commands())
            for (Command& command : commands)
                if (command.name == own.name)
                    command = std::move(own);
    return commands;
}

namespace {

struct ManualArguments {
    std::string what = "man", subcommand;
    bool markdown = false;
};

Status print_markdown(const std::string& name)
{
    bool found = false;
    const std::vector<Command> commands = all_commands();
    for (const Command& command : commands) {
        if (name.empty() ? !command.run : command.name != name)
            continue; // burnish-lab prints the laboratory's
        std::fputs(((found ? "\n" : "") + markdown_page(command, commands)).c_str(), stdout);
        found = true;
    }
    return found ? Status() : usage_error("SUBCOMMAND", "there is no subcommand '" + name + "'");
}

// Returns true for the laboratory's subcommands: burnish-lab has their options and prints their pages.
bool asks_lab(const std::string& name)
{
    const std::vector<Command> commands = all_commands();
    return std::any_of(commands.begin(), commands.end(), [&](const Command& c) { return c.name == name && !c.run; });
}

int run_manual(const ManualArguments& arguments)
{
    if (arguments.markdown && arguments.what != "man" && arguments.what != "markdown")
        return fail(usage_error("--markdown", "is the reference, and no completion for a shell"));
    if (arguments.markdown || arguments.what == "markdown") {
        if (asks_lab(arguments.subcommand))
            return start_lab({"manual", "markdown", arguments.subcommand});
        const Status printed = print_markdown(arguments.subcommand);
        return printed ? 0 : fail(printed.error());
    }
    if (!arguments.subcommand.empty())
        return fail(usage_error("SUBCOMMAND", "needs markdown before it"));
    using Text = std::string (*)(const std::vector<Command>&);
    const std::pair<const char*, Text> texts[] = {
        {"man", man_page}, {"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}};
    for (const auto& [name, text] : texts)
        if (arguments.what == name)
            std::fputs(text(all_commands()).c_str(), stdout);
    return 0;
}

} // namespace

Command manual_command()
{
    auto arguments = std::make_shared<ManualArguments>();
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(arguments->what, {"man", "bash", "zsh", "fish", "markdown"})},
                   {"SUBCOMMAND", "", "Subcommand for a markdown page of the reference", text(arguments->subcommand), "all of them"},
                   {"--markdown", "", "The same as markdown: all pages of the reference", flag(arguments->markdown)}});
    return {"manual", "Print the manual page, a page of the reference, or completions for a shell", table,
            "Examples:\n  burnish manual | man -l -\n  source <(burnish manual bash)\n  burnish manual fish > "
            "~/.config/fish/completions/burnish.fish\n  burnish manual markdown render > render.md",
            [arguments](OptionTable&) { return run_manual(*arguments); }};
}

} // namespace burnish
