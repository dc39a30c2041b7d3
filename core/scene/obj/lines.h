// The text of an OBJ file as statements: lines, words and numbers, by no locale.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace burnish::obj {

// Statements one after the other. Lines end in CR, LF or both; a backslash at a line's end goes on with the next; "#" at its beginning or
// after a blank begins a comment. A byte order mark is skipped.
class Lines {
  public:
    explicit Lines(std::string_view text);
    bool next(); // false at the end
    // Without comment and line end; until the next call.
    std::string_view text() const { return line_; }
    std::uint64_t number() const { return first_; } // of the statement's first line, from 1
    bool painted() const { return painted_; }       // a "#MRGB" comment came by: ZBrush's colours of vertices

  private:
    std::string_view take_line();
    bool without_comment(std::string_view& line);

    std::string_view rest_, line_;
    std::string joined_;
    std::uint64_t first_ = 0, read_ = 0;
    bool painted_ = false;
};

// Takes the first word of the text; empty at the end.
std::string_view take_word(std::string_view& text);
std::string_view trimmed(std::string_view text);

enum class Number { read, none, too_large };

// A decimal number that is all of the word: no infinity, NaN or hexadecimal one, nothing behind it.
Number read_number(std::string_view word, float& value);
Number read_index(std::string_view word, std::int64_t& value);

} // namespace burnish::obj
