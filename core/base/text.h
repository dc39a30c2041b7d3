// Text that comes from files and file names, made fit for a terminal, a page or a log.
#pragma once
#include <string>

namespace burnish {

// One line of valid UTF-8 without control characters: line breaks and tabs become spaces; every other byte of a control character, of a
// character that turns the direction of writing, or of what is no UTF-8 becomes "\xHH". Of a text above
// `most_bytes` only so many, then "...".
std::string printable(const std::string& text, std::size_t most_bytes = std::string::npos);

// The same for a text of several lines, whose line feeds stay.
std::string printable_lines(const std::string& text);

// Returns the number whose shortest decimal is the float's: 0.4 of 0.4f, where a conversion gives 0.4000000059604645.
double shortest_decimal(float value);

} // namespace burnish
