// Holds the words of the command that this process runs.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Keeps the command's words for the rest of the process.
void keep_words(const std::vector<std::string>& words);
// Returns the words of keep_words().
const std::vector<std::string>& kept_words();

} // namespace burnish
