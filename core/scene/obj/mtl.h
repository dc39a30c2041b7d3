// Reads MTL files, the material libraries of OBJ files.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

#include <glm/glm.hpp>

namespace burnish::obj {

struct MtlMap { // a picture and how it lies; empty: none
    std::string file;
    glm::vec2 scale{1.0f}, offset{0.0f}; // coordinates as in the file, v up: coordinate * scale + offset
    float strength = 1.0f;               // -bm
    bool clamps = false;
};

struct MtlMaterial { // numbers that the file does not name are empty
    std::string name;
    std::optional<glm::vec3> diffuse, specular, emission;                            // Kd, Ks, Ke: linear
    std::optional<float> exponent, opacity, ior;                                     // Ns, d or 1 - Tr, Ni
    std::optional<float> roughness, metallic, clearcoat, clearcoat_roughness, sheen; // Pr, Pm, Pc, Pcr, Ps
    std::optional<float> anisotropy, rotation;                                       // aniso, [-1,1]; anisor, turns
    MtlMap diffuse_map, specular_map, exponent_map, emission_map, roughness_map, metallic_map, normal_map, opacity_map;
    MtlMap sheen_map, bump_map; // bump: heights, or normals from programs that write them so
};

struct MtlLibrary {
    std::vector<MtlMaterial> materials; // with different names
    std::vector<std::string> warnings;  // one line each, each kind once
    std::optional<Error> wrong;         // the first unreadable statement
};

// Parses a file's text. `path` names the file in messages. Statements without effect on pictures are skipped; others that are not read give
// a warning. Numbers outside their range are clamped, with a warning. Errors: numbers that are none.
MtlLibrary parse_mtl(const std::string& path, const std::string& text);

} // namespace burnish::obj
