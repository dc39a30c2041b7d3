// The given options as part of a piece's key.
#pragma once
#include <string>

#include "apps/cli/option.h"

namespace burnish {

// Returns each given option that decides pictures, by its name and texts. Files count by their content; outputs do not count.
std::string text_of_given(const OptionTable& given);

} // namespace burnish
