// Contents of an OBJ file, before validation.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish::obj {

// Smoothing groups: kFaceted (0) means none; kUnsaid where the file has not named a group yet.
inline constexpr std::uint32_t kFaceted = 0, kUnsaid = 0xFFFFFFFF;

struct Corner {
    std::int64_t position, uv, normal; // from 0; -1: none
    std::uint32_t smoothing;
};

struct Group {
    std::string name;
    std::string material;        // as usemtl names it; empty: none
    std::vector<Corner> corners; // of all polygons, in sequence
    std::vector<std::uint32_t> counts;
};

struct Parsed {
    std::vector<float> positions, uvs, normals; // 3, 2 and 3 numbers for each
    std::vector<float> colours;                 // 3 for each position, as written, [0,1]; white for a position without colour; empty: none
    std::vector<Group> groups;                  // never empty groups
    std::vector<std::string> libraries;         // as mtllib names them
    std::vector<std::string> warnings;          // skipped contents, each kind once
    std::optional<Error> wrong;                 // the first unreadable statement
};

// Parses the whole file `text`.
Parsed parse(const std::string& path, const std::string& text);

} // namespace burnish::obj
