// Splits an OBJ file into statements: lines, words and numbers, independent of the locale.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace burnish::obj {

// Iterates over statements. Lines end in CR, LF or both. A backslash at a line's end continues with the next line. "#"
// starts a comment at a line's start or after a blank. Skips a byte order mark.
class Lines {
  public:
    explicit Lines(std::string_view text);
    bool next(); // false at the end
    // Returns the statement without comment and line end; valid until the next call.
    std::string_view text() const { return line_; }
    std::uint64_t number() const { return first_; } // first line of the statement, from 1
    bool painted() const { return painted_; }       // true after a "#MRGB" comment: ZBrush's vertex colours

  private:
    std::string_view take_line();
    bool without_comment(std::string_view& line);

    std::string_view rest_, line_;
    std::string joined_;
    std::uint64_t first_ = 0, read_ = 0;
    bool painted_ = false;
};

// Removes and returns the text's first word; empty at the end.
std::string_view take_word(std::string_view& text);
std::string_view trimmed(std::string_view text);

enum class Number { read, none, too_large };

// Reads a decimal number that fills the whole word: no infinity, NaN or hexadecimal number, and no characters after it.
Number read_number(std::string_view word, float& value);
Number read_index(std::string_view word, std::int64_t& value);

} // namespace burnish::obj
