// Makes the values of options. Each Value reads texts, explains errors, and stores into `to`, which must outlive the Value. The initial
// content of `to` is the default.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "apps/cli/option.h"
#include "apps/cli/parse.h"
#include "core/scene/scene.h"

namespace burnish {
namespace value_detail {

using Integer = std::optional<std::int64_t>; // none: an empty optional
using Number = std::optional<double>;
Value integer(std::int64_t low, std::int64_t high, std::function<void(std::int64_t)> put, std::function<Integer()> get);
Value number(double low, double high, std::function<void(double)> put, std::function<Number()> get);
Value name(std::vector<std::string> names, std::function<void(std::size_t)> put, std::function<std::size_t()> get);

template <class T> struct Held { // the type inside T or std::optional<T>
    using Type = T;
    static constexpr bool optional = false;
};
template <class T> struct Held<std::optional<T>> {
    using Type = T;
    static constexpr bool optional = true;
};
template <class As, class T> std::optional<As> held(const T& from)
{
    if constexpr (Held<T>::optional)
        return from ? std::optional<As>(static_cast<As>(*from)) : std::nullopt;
    else
        return static_cast<As>(from);
}

} // namespace value_detail

Value flag(bool& to, bool becomes = true);
Value count(int& to); // number of occurrences
Value bytes(std::uint64_t& to);
Value picture_size(PictureSize& to);
Value angles(glm::vec2& to, double low, double high);     // degrees
Value angles_rad(glm::vec2& to, double low, double high); // degrees on the command line and in the range, radians in `to`
Value direction(std::optional<glm::vec2>& to);            // azimuth and elevation, degrees
Value point(std::optional<glm::vec3>& to);
Value place(std::optional<glm::dvec3>& to); // world space, double precision
Value colour(std::optional<glm::vec3>& to); // red, green and blue, [0,1]
Value text(std::string& to);
Value texts(std::vector<std::string>& to); // one for each occurrence
Value file(std::string& to);
Value files(std::vector<std::string>& to); // one for each occurrence
Value folder(std::string& to);

// A path, or "builtin:NAME" with a known name.
Value scene(std::string& to);
Value scenes(std::vector<std::string>& to);
Value environment(std::string& to);
Value environments(std::vector<std::string>& to);
Value area_lights(std::vector<AreaLight>& to); // one for each occurrence
Value extracted_lights(int& to);               // the largest number; auto, off, or a number

// Several words with commas between. `names`: the valid words; empty: any word.
Value choices(std::vector<std::string>& to, std::vector<std::string> names);
Value choices(std::vector<int>& to, const std::vector<int>& numbers);
// "all" or names with commas between, in registry order.
Value techniques_value(std::vector<std::string>& to);

template <class T> Value integer(T& to, std::int64_t low, std::int64_t high)
{
    using Type = typename value_detail::Held<T>::Type;
    return value_detail::integer(
        low, high, [&to](std::int64_t value) { to = static_cast<Type>(value); }, [&to] { return value_detail::held<std::int64_t>(to); });
}

template <class T> Value number(T& to, double low, double high)
{
    using Type = typename value_detail::Held<T>::Type;
    return value_detail::number(
        low, high, [&to](double value) { to = static_cast<Type>(value); }, [&to] { return value_detail::held<double>(to); });
}

// One name out of a few: an enumeration counted from 0 in the order of names, a bool, or the name itself.
template <class T> Value choice(T& to, std::vector<std::string> names)
{
    if constexpr (std::is_same_v<T, std::string>) {
        return value_detail::name(
            names, [&to, names](std::size_t i) { to = names[i]; },
            [&to, names] {
                std::size_t i = 0;
                while (i < names.size() && names[i] != to)
                    ++i;
                return i;
            });
    } else {
        static_assert(std::is_enum_v<T> || std::is_same_v<T, bool>);
        return value_detail::name(
            std::move(names), [&to](std::size_t i) { to = static_cast<T>(i); }, [&to] { return static_cast<std::size_t>(to); });
    }
}
Value choice(int& to, const std::vector<int>& numbers); // one number out of a few

// Adds a hint to the error if the refused word is one of these.
using Hints = std::vector<std::pair<std::string, std::string>>;
Value hinted(Value value, Hints hints);

} // namespace burnish
