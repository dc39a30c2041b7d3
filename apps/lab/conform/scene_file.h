// Writes a small scene as a glTF file that holds everything: mesh, textures, camera, lamp.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/report/json.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

struct FileVertex {
    glm::vec3 position{0.0f}, normal{0.0f, 0.0f, 1.0f};
    glm::vec4 tangent{1.0f, 0.0f, 0.0f, 1.0f};
    glm::vec2 uv0{0.0f}, uv1{0.0f};
};

struct SceneFile {
    std::vector<FileVertex> vertices;
    std::vector<std::uint32_t> triangles;
    bool tangents = true;                             // in the file
    Json material = Json::object();                   // as glTF has it; texture indices count `textures`
    std::vector<Image> textures;                      // u8 RGB
    std::vector<glm::mat4> nodes = {glm::mat4(1.0f)}; // from the mesh's own node to the root
    glm::vec3 eye{0.0f, 0.6f, 4.2f}, target{0.0f};
    float fov_y_rad = 0.5235988f, aspect = 4.0f / 3.0f;
    bool lamp = false; // a directional light
};

// Returns the file's text.
Result<std::string> scene_file_text(const std::string& name, const SceneFile& scene);

} // namespace burnish
