// The manual page, pages of the reference and the completions of shells, made of the tables of options that the command line is read by.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/command.h"

namespace burnish {

std::string man_page(const std::vector<Command>& commands); // roff, section 1
std::string bash_completion(const std::vector<Command>& commands);
std::string zsh_completion(const std::vector<Command>& commands);
std::string fish_completion(const std::vector<Command>& commands);

// A page of the reference, apps/manual/reference/NAME.md: what the subcommand does, its options as tables, its examples.
std::string markdown_page(const Command& command);

} // namespace burnish
