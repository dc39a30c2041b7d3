#include "apps/cli/words.h"

namespace burnish {

namespace {
std::vector<std::string> given_words;
}

void set_command_words(const std::vector<std::string>& words)
{
    given_words = words;
}

const std::vector<std::string>& command_words()
{
    return given_words;
}

} // namespace burnish
