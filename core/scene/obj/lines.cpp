#include "core/scene/obj/lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace burnish::obj {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// Removes a sign and returns true for a minus. charconv knows no plus.
bool take_sign(std::string_view& word)
{
    const bool minus = word.starts_with('-');
    if (minus || word.starts_with('+'))
        word.remove_prefix(1);
    return minus;
}

} // namespace

std::string_view take_word(std::string_view& text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    return word;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

Number read_number(std::string_view word, float& value)
{
    const bool minus = take_sign(word);
    if (word.empty() || !(is_digit(word[0]) || word[0] == '.'))
        return Number::none;
    const char* const end = word.data() + word.size();
    double wide = 0.0; // in double range, to distinguish underflow from overflow of a float
    const std::from_chars_result read = std::from_chars(word.data(), end, wide);
    if (read.ptr != end || read.ec == std::errc::invalid_argument)
        return Number::none;
    float narrow = 0.0f;
    if (std::from_chars(word.data(), end, narrow).ec != std::errc()) {
        if (read.ec != std::errc() || wide > 1.0)
            return Number::too_large;
        narrow = static_cast<float>(wide);
    }
    value = minus ? -narrow : narrow;
    return Number::read;
}

Number read_index(std::string_view word, std::int64_t& value)
{
    const bool minus = take_sign(word);
    if (word.empty() || !is_digit(word[0]))
        return Number::none;
    const char* const end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(word.data(), end, value);
    if (read.ptr != end)
        return Number::none;
    if (read.ec != std::errc())
        return Number::too_large;
    value = minus ? -value : value;
    return Number::read;
}

Lines::Lines(std::string_view text) : rest_(text)
{
    constexpr std::string_view kMark = "\xEF\xBB\xBF"; // twice where files were joined
    while (rest_.starts_with(kMark))
        rest_.remove_prefix(kMark.size());
}

std::string_view Lines::take_line()
{
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : rest_.empty() ? 0 : 1);
    ++read_;
    return line;
}

// Removes a comment, or a trailing backslash and blanks after it. Returns true where the line continues; a backslash inside a comment does
// not count.
bool Lines::without_comment(std::string_view& line)
{
    for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
        if (at > 0 && kBlanks.find(line[at - 1]) == std::string_view::npos)
            continue; // part of a name, as "part#2"
        painted_ = painted_ || line.substr(at).starts_with("#MRGB ");
        line = line.substr(0, at);
        return false;
    }
    const std::size_t last = line.find_last_not_of(kBlanks);
    if (last == std::string_view::npos || line[last] != '\\')
        return false;
    line = line.substr(0, last);
    return true;
}

bool Lines::next()
{
    if (rest_.empty())
        return false;
    first_ = read_ + 1;
    line_ = take_line();
    if (!without_comment(line_))
        return true;
    joined_ = line_;
    for (bool more = true; more && !rest_.empty();) {
        std::string_view line = take_line();
        more = without_comment(line);
        joined_ += ' ';
        joined_ += line;
    }
    line_ = joined_;
    return true;
}

} // namespace burnish::obj
