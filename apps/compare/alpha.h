// Pictures of which only one has alpha: what is drawn with and without a background.
#pragma once
#include <string>

#include "core/image/image.h"

namespace burnish {

// Takes the alpha from the one that alone has it, so that colours are compared. Returns a line that says so; empty where both or neither
// have alpha, or where they differ in more than that.
std::string drop_lone_alpha(Image& reference, const std::string& reference_name, Image& test, const std::string& test_name);

} // namespace burnish
