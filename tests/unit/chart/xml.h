// Checks that a text is well-formed XML, as far as charts need it.
#pragma once
#include <string>

namespace burnish::test {

// Returns an empty string, or the fault and its place. Checks for one root element, matching ends, unique quoted attributes and known
// entities.
std::string xml_fault(const std::string& text);

} // namespace burnish::test
