// Files in a row, named by a pattern with one number in it: frame_%04d.exr.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

bool has_number(const std::string& pattern);                  // %d, %4d or %04d, once
std::string numbered(const std::string& pattern, int number); // of a pattern that has one

// The numbers for which a file of that name exists, from the least on. Errors: the folder cannot be read.
Result<std::vector<int>> existing_numbers(const std::string& pattern);

} // namespace burnish
