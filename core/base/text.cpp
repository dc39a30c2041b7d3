#include "core/base/text.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace burnish {
namespace {

struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0; // 0 for invalid UTF-8 (RFC 3629)
};

Character character_at(const std::string& text, std::size_t at)
{
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
    const std::uint32_t first = byte(at);
    if (first < 0x80)
        return {first, 1};
    const std::size_t bytes = first >= 0xC2 && first <= 0xDF   ? 2
                              : first >= 0xE0 && first <= 0xEF ? 3
                              : first >= 0xF0 && first <= 0xF4 ? 4
                                                               : 0;
    if (bytes == 0 || at + bytes > text.size())
        return {};
    std::uint32_t code = first & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80)
            return {};
        code = code << 6 | (byte(at + i) & 0x3F);
    }
    const std::uint32_t least = bytes == 2 ? 0x80 : bytes == 3 ? 0x800 : 0x10000;
    if (code < least || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF))
        return {};
    return {code, bytes};
}

bool is_hidden(std::uint32_t code)
{
    const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x2028 || code == 0x2029;
    const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0x200E || code == 0x200F;
    return control || turns || code == 0xFEFF || code == 0xFFFE || code == 0xFFFF; // XML excludes the last two
}

std::string shown(const std::string& text, bool keep_line_feeds)
{
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const Character c = character_at(text, at);
        const std::size_t bytes = c.bytes ? c.bytes : 1;
        if (c.bytes && (!is_hidden(c.code) || (keep_line_feeds && c.code == '\n'))) {
            out.append(text, at, bytes);
        } else if (c.bytes && (c.code == '\n' || c.code == '\r' || c.code == '\t')) {
            out += ' ';
        } else {
            for (std::size_t i = 0; i < bytes; ++i) {
                char hex[5];
                std::snprintf(hex, sizeof(hex), "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(text[at + i])));
                out += hex;
            }
        }
        at += bytes;
    }
    return out;
}

} // namespace

std::string printable(const std::string& text, std::size_t most_bytes)
{
    if (text.size() <= most_bytes)
        return shown(text, false);
    std::size_t end = most_bytes; // cut no character in two
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end;
    return shown(text.substr(0, end), false) + "...";
}

double shortest_decimal(float value)
{
    if (!std::isfinite(value))
        return static_cast<double>(value);
    char text[32];
    const auto written = std::to_chars(text, text + sizeof text, value);
    double number = 0.0;
    std::from_chars(text, written.ptr, number);
    return number;
}

std::string printable_lines(const std::string& text)
{
    return shown(text, true);
}

std::vector<std::string> split(const std::string& text, char at)
{
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == at)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

std::optional<std::vector<std::string>> split_words(const std::string& text)
{
    std::vector<std::string> words;
    bool within = false; // a word
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
            within = false;
            continue;
        }
        if (!within)
            words.emplace_back();
        within = true;
        if (c == quote)
            quote = 0;
        else if (quote == 0 && (c == '"' || c == '\''))
            quote = c;
        else if (c == '\\' && quote != '\'' && i + 1 < text.size())
            words.back() += text[++i];
        else
            words.back() += c;
    }
    return quote == 0 ? std::optional(words) : std::nullopt;
}

} // namespace burnish
