#include "apps/cli/words.h"

namespace burnish {

namespace {
std::vector<std::string> kept;
}

void keep_words(const std::vector<std::string>& words)
{
    kept = words;
}

const std::vector<std::string>& kept_words()
{
    return kept;
}

} // namespace burnish
