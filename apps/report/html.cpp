#include "apps/report/html.h"

#include <algorithm>
#include <cstdint>

#include "core/base/text.h"

namespace burnish {

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : printable(text))
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    return out;
}

std::string without_controls(std::string text)
{
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 32)
            c = ' ';
    return text;
}

std::string script_json(const Json& json)
{
    std::string text = json_text(json, -1);
    for (std::size_t at = text.find('<'); at != std::string::npos;
         at = text.find('<', at + 1)) // "</" and "<!--" would end or hide the script
        text.replace(at, 1, "\\u003c");
    return text;
}

std::string base64(const std::string& bytes)
{
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += k <= n ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
}

} // namespace burnish
