// Compares pictures of which only one has alpha: rendered with and without a background.
#pragma once
#include <string>

#include "core/image/image.h"

namespace burnish {

// Drops the alpha channel if only one picture has alpha, so that colours are compared. Returns a note about this. Empty if both or
// neither have alpha, or if the pictures differ in another way too.
std::string drop_lone_alpha(Image& reference, const std::string& reference_name, Image& test, const std::string& test_name);

} // namespace burnish
