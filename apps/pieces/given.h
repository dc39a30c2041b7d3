// The given options as part of a piece's key.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"

namespace burnish {

// Returns each given option that decides pictures, by its name and texts. Files count by their content, files of a folder by their names
// too. Outputs, limits and the scene do not count.
std::string text_of_given(const OptionTable& given);

// Returns a scene by its word where it is built in, else by the content of its files.
std::string text_of_scene(const std::string& word, const std::vector<std::string>& files);

} // namespace burnish
