// Makes text from files and file names safe for a terminal, a page or a log; splits texts.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace burnish {

// Returns one line of valid UTF-8 without control characters. Line breaks and tabs become spaces. The bytes of other
// control characters, of characters that change the writing direction, and of invalid UTF-8 become "\xHH". Cuts a text
// longer than `most_bytes` there and adds "...".
std::string printable(const std::string& text, std::size_t most_bytes = std::string::npos);

// Returns printable text of several lines: line feeds stay.
std::string printable_lines(const std::string& text);

// Returns the first line of a library's message, without its full stop.
inline std::string first_line(const std::string& text)
{
    std::string line = text.substr(0, text.find_first_of("\r\n"));
    while (!line.empty() && (line.back() == ' ' || line.back() == '.'))
        line.pop_back();
    return line;
}

std::vector<std::string> split(const std::string& text, char at); // n separators give n + 1 parts

// Returns the words between blanks. Single or double quotes keep blanks. A backslash keeps the next character, except within single quotes.
// Returns nothing for a quote that does not end.
std::optional<std::vector<std::string>> split_words(const std::string& text);

// Returns the number with the float's shortest decimal: 0.4 for 0.4f, where a conversion gives 0.4000000059604645.
double shortest_decimal(float value);

} // namespace burnish
