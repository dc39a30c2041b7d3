// Makes scene materials of MTL libraries.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {
class Jobs;
}

namespace burnish::obj {

// Appends the materials of the libraries that an OBJ file names, with their textures. Returns their indices by name. A missing library or
// picture gives a warning. Pictures lie below the OBJ file's folder, unless Limits::uris_outside; else a picture with the same name in that
// folder is taken. Errors: damaged libraries and pictures; exceeded limits.
//
// Kd base colour; Ks .5 is glTF's default reflectance of .04; Ns n a roughness of (2 / (n + 2))^(1/4), none 1; Ke emission; d or Tr blend;
// Ni above 1 the index. Pr, Pm, Pc, Pcr, aniso and anisor (turns) are the extension for physically based rendering. map_Kd, map_Ke, map_Pr,
// map_Pm and norm are read; map_d where it is map_Kd, whose alpha then cuts out.
// jobs: threads that decode pictures; null: the calling thread alone. The materials are the same.
Result<std::map<std::string, std::int32_t>> read_materials(Scene& scene, const std::string& obj, const std::vector<std::string>& libraries,
                                                           const Limits& limits, const Jobs* jobs = nullptr);

} // namespace burnish::obj
