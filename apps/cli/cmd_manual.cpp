// `burnish manual`: the manual page and the completions, as they are installed.
#include <cstdio>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/manual.h"
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

Command manual_command()
{
    auto what = std::make_shared<std::string>("man");
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(*what, {"man", "bash", "zsh", "fish"})}});
    return {"manual", "Print the manual page, or the completions of a shell", table,
            "Examples:\n  burnish manual | man -l -\n  source <(burnish manual bash)\n  burnish manual fish > "
            "~/.config/fish/completions/burnish.fish",
            [what](OptionTable&) {
                using Text = std::string (*)(const std::vector<Command>&);
                const std::pair<const char*, Text> texts[] = {
                    {"man", man_page}, {"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}};
                for (const auto& [name, text] : texts)
                    if (*what == name)
                        std::fputs(text(all_commands()).c_str(), stdout);
                return 0;
            }};
}

} // namespace burnish
