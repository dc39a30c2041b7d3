// Readers of option values in the C interface. Errors: ExitCode::usage without a place.
#pragma once
#include <charconv>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "raster/frame/comma_numbers.h"

namespace burnish {

inline constexpr double kAny = static_cast<double>(std::numeric_limits<float>::max()); // bound in .def files: any float

inline Error wrong_value(const std::string& reason)
{
    return Error{ExitCode::usage, "", "", reason};
}

// Returns "1 to 16", or "0 or more", or an empty text for any number.
inline std::string range_text(double least, double most)
{
    if (most >= kAny)
        return least <= -kAny ? "" : fmt::format("{:g} or more", least);
    return fmt::format("{} to {}", least, most);
}

// Reads `count` numbers with commas between, each from `least` to `most`.
inline Status put_numbers(const std::string& text, float* to, std::size_t count, double least = -kAny, double most = kAny)
{
    const std::optional<std::vector<float>> numbers = comma_numbers(text);
    if (!numbers)
        return wrong_value("'" + text + (count == 1 ? "' is no number" : "' is no list of numbers with commas between"));
    if (numbers->size() != count)
        return wrong_value(fmt::format("'{}' has {} numbers, not {}", text, numbers->size(), count));
    for (const float value : *numbers) // bounds round as values do
        if (!(value >= static_cast<float>(least) && value <= static_cast<float>(most)))
            return wrong_value(fmt::format("'{}' does not lie in {}..{}", text, least, most >= kAny ? "inf" : fmt::format("{}", most)));
    for (std::size_t i = 0; i < count; ++i)
        to[i] = (*numbers)[i];
    return {};
}

inline Status put_within(const std::string& text, float& to, double least, double most)
{
    return put_numbers(text, &to, 1, least, most);
}
template <int n> Status put_within(const std::string& text, glm::vec<n, float>& to, double least, double most)
{
    return put_numbers(text, &to[0], n, least, most);
}

// Reads a whole number from `least` to `most`.
inline Status put_whole(const std::string& text, int& to, int least, int most)
{
    int value = 0;
    const auto [next, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failed != std::errc() || next != text.data() + text.size())
        return wrong_value("'" + text + "' is no whole number");
    if (value < least || value > most)
        return wrong_value(fmt::format("'{}' does not lie in {}..{}", text, least, most));
    to = value;
    return {};
}

inline Status put_flag(const std::string& text, bool& to)
{
    if (text != "true" && text != "false" && text != "1" && text != "0")
        return wrong_value("'" + text + "' is neither true nor false");
    to = text == "true" || text == "1";
    return {};
}

// Returns the names with commas between.
inline std::string joined(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names)
        out += (out.empty() ? "" : ", ") + name;
    return out;
}

// Reads one of the names as its index.
inline Status put_name(const std::string& text, const std::vector<std::string>& names, std::size_t& to)
{
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == text) {
            to = i;
            return {};
        }
    return wrong_value("'" + text + "' is none of " + joined(names));
}

} // namespace burnish
