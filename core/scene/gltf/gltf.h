// glTF 2.0 input: .gltf and .glb files into Scene tables.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

Result<Scene> load_gltf(const std::string& path, const Limits& limits, const Moment& moment = {});

// The same from memory; there is no folder, so external files are refused. `label` names the input in errors.
Result<Scene> load_gltf_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                              const Moment& moment = {});

// "builtin:NAME" or a .gltf/.glb path.
Result<Scene> load_scene(const std::string& spec, const Limits& limits, const Moment& moment = {});

} // namespace burnish
