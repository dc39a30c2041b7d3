// Comparisons of many pictures: of two folders, and of two sequences.
#pragma once
#include "apps/compare/options.h"

namespace burnish {

// Compares the pictures of equal relative paths. Returns the exit code of the gravest picture. Missing and unreadable ones come first, then
// sizes that do not match, NaN, and limits.
int compare_folders(const CompareOptions& options);

// With --sequence: compares each picture with its reference, and successive pictures with each other. Returns the exit code.
int compare_sequences(const CompareOptions& options);

} // namespace burnish
