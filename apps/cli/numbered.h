// File sequences, named by a pattern with one number: frame_%04d.exr.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

bool has_number(const std::string& pattern);                  // %d, %4d or %04d, exactly once
std::string numbered(const std::string& pattern, int number); // for a pattern with a number

// Returns the numbers of existing files, in ascending order. Fails if the folder cannot be read.
Result<std::vector<int>> existing_numbers(const std::string& pattern);

} // namespace burnish
