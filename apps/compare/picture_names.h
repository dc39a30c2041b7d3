// Pictures in folders.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// Returns the paths, relative to its folder, of each picture below either folder, in ascending order, each once. Fails where there is
// none or a folder cannot be read.
Result<std::vector<std::string>> picture_names(const std::string& expected, const std::string& actual);

// Patterns are paths with one '*', in the file name. Returns the parts of names that '*' covers, of each picture that matches either
// pattern, in ascending order, each once. Fails where there is none, or a pattern is none.
Result<std::vector<std::string>> covered_parts(const std::string& expected, const std::string& actual);
std::string with_part(const std::string& pattern, const std::string& part); // the path, with the part in place of '*'

} // namespace burnish
