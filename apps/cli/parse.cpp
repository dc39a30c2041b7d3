#include "apps/cli/parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/suggest.h"
#include "raster/frame/area_light_text.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

// Reads the whole of [first, last) as one value. std::from_chars ignores the locale, so "0,5" means the same on every machine.
template <class T> bool read_all(const char* first, const char* last, T& value)
{
    if (first != last && *first == '+' && ++first != last && *first == '-')
        return false;
    const std::from_chars_result read = std::from_chars(first, last, value);
    return read.ec == std::errc() && read.ptr == last;
}

} // namespace

Result<PictureSize> parse_picture_size(const std::string& option, const std::string& text)
{
    PictureSize size;
    const std::size_t cross = text.find('x');
    const char* begin = text.data();
    const char* end = begin + text.size();
    if (cross == std::string::npos || !read_all(begin, begin + cross, size.width) || !read_all(begin + cross + 1, end, size.height))
        return usage_error(option, fmt::format("expected WIDTHxHEIGHT such as 1280x720, got '{}'", text));
    return size;
}

// Vector: glm::vec3 or glm::dvec3.
template <class Vector> static Result<Vector> parse_three(const std::string& option, const std::string& text)
{
    Vector value{};
    const char* at = text.data();
    const char* end = at + text.size();
    bool good = true;
    for (int axis = 0; axis < 3 && good; ++axis) {
        const char* stop = at;
        while (stop != end && *stop != ',')
            ++stop;
        good = read_all(at, stop, value[axis]) && std::isfinite(value[axis]) && (stop == end) == (axis == 2);
        at = stop == end ? end : stop + 1;
    }
    if (!good)
        return usage_error(option, fmt::format("expected three numbers such as 1,0.5,2, got '{}'", text));
    return value;
}

Result<glm::vec3> parse_vec3(const std::string& option, const std::string& text)
{
    return parse_three<glm::vec3>(option, text);
}

Result<glm::dvec3> parse_dvec3(const std::string& option, const std::string& text)
{
    const Result<glm::vec3> fits = parse_three<glm::vec3>(option, text); // refuses values that overflow a float
    return fits ? parse_three<glm::dvec3>(option, text) : Result<glm::dvec3>(fits.error());
}

Result<double> parse_number(const std::string& option, const std::string& text, double low, double high)
{
    double value = 0.0;
    // The comparison is false for NaN, so NaN is refused.
    if (!read_all(text.data(), text.data() + text.size(), value) || !(value >= low && value <= high))
        return usage_error(option, fmt::format("expected a number from {:g} to {:g}, got '{}'", low, high, text));
    return value;
}

Result<std::int64_t> parse_integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high)
{
    std::int64_t value = 0;
    if (!read_all(text.data(), text.data() + text.size(), value) || value < low || value > high)
        return usage_error(option, fmt::format("expected a whole number from {} to {}, got '{}'", low, high, text));
    return value;
}

Result<std::uint64_t> parse_bytes(const std::string& option, const std::string& text)
{
    std::size_t digits = text.size();
    unsigned shift = 0;
    const char unit = text.empty() ? '\0' : text.back();
    if (unit == 'K' || unit == 'M' || unit == 'G') {
        shift = unit == 'K' ? 10 : unit == 'M' ? 20 : 30;
        --digits;
    }
    std::uint64_t value = 0;
    const bool good = read_all(text.data(), text.data() + digits, value) && value > 0;
    if (!good || value > (std::uint64_t{1} << 62) >> shift)
        return usage_error(option, fmt::format("expected a number of bytes such as 64K, 512M or 4G, got '{}'", text));
    return value << shift;
}

Result<AreaLight> parse_area_light(const std::string& option, const std::string& text)
{
    const Result<AreaLight> light = area_light_of(text, did_you_mean);
    return light ? light : Result<AreaLight>(usage_error(option, light.error().reason));
}

std::vector<std::string> technique_names()
{
    std::vector<std::string> names = {automatic_technique().name};
    for (const TechniqueInfo& technique : techniques())
        names.emplace_back(technique.name);
    return names;
}

Result<std::vector<std::string>> parse_techniques(const std::string& text, const std::string& option)
{
    const std::vector<std::string> known = technique_names();
    std::vector<std::string> chosen;
    if (text == "all")
        return std::vector<std::string>(known.begin() + 1, known.end());
    const std::vector<std::string> wanted = split(text, ',');
    for (const std::string& name : wanted)
        if (!find_technique(name))
            return usage_error(option, fmt::format("'{}' is not one of all, {}{}", name, join(known), did_you_mean(name, known)));
    for (const std::string& name : known)
        if (std::find(wanted.begin(), wanted.end(), name) != wanted.end())
            chosen.push_back(name);
    return chosen;
}

} // namespace burnish
