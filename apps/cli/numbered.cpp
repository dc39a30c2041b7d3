#include "apps/cli/numbered.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fmt/core.h>

namespace burnish {
namespace {

// Position of the number in a pattern: "%", digits, "d".
struct Place {
    std::size_t begin = std::string::npos, end = 0;
    int width = 0;
    bool zeros = false;
};

Place number_place(const std::string& pattern)
{
    Place found;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%')
            continue;
        std::size_t at = i + 1;
        const bool zeros = at < pattern.size() && pattern[at] == '0';
        int width = 0;
        for (; at < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[at])) && width < 100; ++at)
            width = width * 10 + (pattern[at] - '0');
        if (at == pattern.size() || pattern[at] != 'd' || width > 20)
            continue;
        if (found.begin != std::string::npos)
            return {}; // only one number is allowed
        found = {i, at + 1, width, zeros};
    }
    return found;
}

} // namespace

bool has_number(const std::string& pattern)
{
    return number_place(pattern).begin != std::string::npos;
}

std::string numbered(const std::string& pattern, int number)
{
    const Place place = number_place(pattern);
    const std::string digits = place.zeros ? fmt::format("{:0{}}", number, place.width) : fmt::format("{:{}}", number, place.width);
    return pattern.substr(0, place.begin) + digits + pattern.substr(place.end);
}

Result<std::vector<int>> existing_numbers(const std::string& pattern)
{
    const std::filesystem::path path(pattern);
    const std::string name = path.filename().string();
    const Place place = number_place(name);
    const std::string before = name.substr(0, place.begin), after = name.substr(place.end);
    std::error_code error;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::vector<int> numbers;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string found = entry->path().filename().string();
        if (found.size() <= before.size() + after.size() || found.rfind(before, 0) != 0 || !found.ends_with(after))
            continue;
        const char *first = found.data() + before.size(), *last = found.data() + found.size() - after.size();
        while (!place.zeros && first + 1 < last && *first == ' ')
            ++first;
        int number = 0;
        const std::from_chars_result read = std::from_chars(first, last, number);
        if (read.ec == std::errc() && read.ptr == last && number >= 0 && numbered(name, number) == found)
            numbers.push_back(number);
    }
    if (error)
        return Error{ExitCode::bad_input, folder.string(), "", error.message()};
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

} // namespace burnish
