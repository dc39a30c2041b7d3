// Text and bytes inside HTML and SVG.
#pragma once
#include <string>

namespace burnish {

std::string escaped(const std::string& text); // for elements and quoted attributes
std::string base64(const std::string& bytes); // RFC 4648, section 4

} // namespace burnish
