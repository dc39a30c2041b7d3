// Reads the values listed in a .def of core/scene, by their path below an object. The schema check has ensured their
// types. A value missing in the file keeps its default.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "core/scene/gltf/document.h"

namespace burnish::gltf {

inline void read_factor(const Json& object, const char* path, float& to)
{
    if (const Json::json_pointer at(path); object.contains(at))
        to = static_cast<float>(object[at].get<double>());
}

template <int kCount> void read_factor(const Json& object, const char* path, glm::vec<kCount, float>& to)
{
    if (const Json::json_pointer at(path); object.contains(at))
        for (int i = 0; i < kCount; ++i)
            to[i] = static_cast<float>(object[at][static_cast<std::size_t>(i)].get<double>());
}

inline void read_flag(const Json& object, const char* path, bool& to)
{
    if (const Json::json_pointer at(path); object.contains(at))
        to = !object[at].is_boolean() || object[at].get<bool>();
}

// Reads an enum value. `words` holds one word for each value, separated by blanks.
template <class Enum> void read_choice(const Json& object, const char* path, std::string_view words, Enum& to)
{
    const Json::json_pointer at(path);
    if (!object.contains(at))
        return;
    const std::string_view before =
        words.substr(0, words.find(object[at].get_ref<const std::string&>())); // the schema check ensures that the word exists
    to = static_cast<Enum>(std::count(before.begin(), before.end(), ' '));
}

} // namespace burnish::gltf
