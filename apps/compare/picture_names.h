// Pictures in folders.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// Returns the paths, relative to its folder, of each picture below either folder, in ascending order, each once. Fails where there is
// none or a folder cannot be read.
Result<std::vector<std::string>> picture_names(const std::string& expected, const std::string& actual);

} // namespace burnish
