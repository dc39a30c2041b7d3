// What an OBJ file says, before anything of it is believed.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish::obj {

// Smoothing groups: 0 is none, faceted; kUnsaid where the file has not named one yet.
inline constexpr std::uint32_t kFaceted = 0, kUnsaid = 0xFFFFFFFF;

struct Corner {
    std::int64_t position, uv, normal; // from 0; -1: none
    std::uint32_t smoothing;
};

struct Group {
    std::string name;
    std::vector<Corner> corners; // of its polygons, one after the other
    std::vector<std::uint32_t> counts;
};

struct Parsed {
    std::vector<float> positions, uvs, normals; // 3, 2 and 3 a piece
    std::vector<float> colours;                 // 3 a position, as written, [0,1], white where it has none; empty: none has
    std::vector<Group> groups;                  // none is empty
    std::vector<std::string> warnings;          // what is left out, each kind once
    std::optional<Error> wrong;                 // the first of what cannot be read
};

// text: the whole file.
Parsed parse(const std::string& path, const std::string& text);

} // namespace burnish::obj
