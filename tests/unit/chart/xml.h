// Whether a text is well-formed XML, as far as charts need it.
#pragma once
#include <string>

namespace burnish::test {

// Empty, or what is wrong and where. One root element, matching ends, quoted attributes given once, entities known.
std::string xml_fault(const std::string& text);

} // namespace burnish::test
