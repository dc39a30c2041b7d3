// Holds the words of the command that this process runs.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Keeps the command's words for the rest of the process.
void set_command_words(const std::vector<std::string>& words);
// Returns the words of set_command_words().
const std::vector<std::string>& command_words();

} // namespace burnish
