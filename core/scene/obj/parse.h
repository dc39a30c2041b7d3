// What an OBJ file says, before anything of it is believed.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish::obj {

struct Corner {
    std::int64_t position, uv, normal; // from 0; -1: none
};

struct Group {
    std::string name;
    std::vector<Corner> corners; // of its polygons, one after the other
    std::vector<std::uint32_t> counts;
};

struct Parsed {
    std::vector<float> positions, uvs, normals; // 3, 2 and 3 a piece
    std::vector<Group> groups;                  // none is empty
    bool names_materials = false;
    std::optional<Error> wrong; // the first index or number that is
};

// text: the whole file.
Parsed parse(const std::string& path, const std::string& text);

} // namespace burnish::obj
