// Compares pictures of which only one has alpha: rendered with and without a background.
#pragma once
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// Drops the alpha channel if only one picture has alpha and alpha is 1 everywhere, so that colours are compared. Returns a note about
// this. Empty if both or neither have alpha, or if the pictures differ in another way too. Errors: ExitCode::size_mismatch for another
// alpha.
Result<std::string> drop_lone_alpha(Image& reference, const std::string& reference_name, Image& test, const std::string& test_name);

} // namespace burnish
