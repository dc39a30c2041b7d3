// The libraries name fields where something is wrong with a setting ("FrameDesc::brdf", "Limits::texture_bytes"), in Error::field and in
// their sentences. People who use the program know options.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// All fields that are set by options: "FrameDesc::brdf", "--brdf".
const std::vector<std::pair<std::string, std::string>>& field_options();

// Replaces the fields in a sentence by their options. Other words stay as they are.
std::string with_options(std::string_view text);

// Returns error.line(), with options in place of fields.
std::string line_of(const Error& error);

} // namespace burnish
