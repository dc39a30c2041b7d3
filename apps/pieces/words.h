// Commands as words.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Returns words that a shell reads as these.
std::string shell_words(const std::vector<std::string>& words);
// Returns a command without its options of pieces.
std::vector<std::string> without_pieces(const std::vector<std::string>& words);
// Returns the command without these, and without options that change no file: threads, instruction set, messages.
std::vector<std::string> job_words(const std::vector<std::string>& words);

} // namespace burnish
