// Reads glTF 2.0 files (.gltf and .glb) into scenes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"

namespace burnish {

// jobs: threads that decode images; null: the calling thread alone. The scene is the same.
Result<Scene> load_gltf(const std::string& path, const Limits& limits, const Moment& moment = {}, const Jobs* jobs = nullptr);

// Reads a scene from memory. Refuses external files, because there is no folder. `label` names the input in errors.
Result<Scene> load_gltf_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                              const Moment& moment = {}, const Jobs* jobs = nullptr);

// Loads "builtin:NAME", an OBJ file, or a .gltf/.glb file.
Result<Scene> load_scene(const std::string& spec, const Limits& limits, const Moment& moment = {}, const Jobs* jobs = nullptr);

} // namespace burnish
