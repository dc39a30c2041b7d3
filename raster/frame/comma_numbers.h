// Numbers in texts.
#pragma once
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace burnish {

// Returns the finite numbers of a text with commas between, or nothing.
inline std::optional<std::vector<float>> comma_numbers(const std::string& text)
{
    std::vector<float> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        float value = 0.0f;
        const auto [next, failed] = std::from_chars(at, end, value);
        if (failed != std::errc() || !std::isfinite(value))
            return std::nullopt;
        numbers.push_back(value);
        if (next == end)
            return numbers;
        if (*next != ',')
            return std::nullopt;
        at = next + 1;
    }
}

} // namespace burnish
