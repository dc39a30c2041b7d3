// Writes the manual page, the reference pages and the shell completions, from the option tables behind the command line.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/command.h"

namespace burnish {

std::string man_page(const std::vector<Command>& commands); // roff, section 1
std::string bash_completion(const std::vector<Command>& commands);
std::string zsh_completion(const std::vector<Command>& commands);
std::string fish_completion(const std::vector<Command>& commands);

// Returns a reference page, apps/manual/reference/NAME.md: the subcommand's purpose, its options as tables, its examples. commands: all of
// them; an option of render that another subcommand shares has the same pictures on both pages.
std::string markdown_page(const Command& command, const std::vector<Command>& commands);

} // namespace burnish
