// Escapes text and bytes for HTML and SVG.
#pragma once
#include <string>

#include "apps/report/json.h"

namespace burnish {

std::string escaped(const std::string& text);   // for elements and quoted attributes
std::string without_controls(std::string text); // control characters become blanks
std::string script_json(const Json& json);      // for a script element, which "</" would end
std::string base64(const std::string& bytes);   // RFC 4648, section 4

} // namespace burnish
