#include "apps/cli/words.h"

namespace burnish {

namespace {
std::vector<std::string> kept;
}

void set_command_words(const std::vector<std::string>& words)
{
    kept = words;
}

const std::vector<std::string>& command_words()
{
    return kept;
}

} // namespace burnish
