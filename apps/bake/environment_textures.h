// Writes a baked environment as textures and extracted lights that engines load: see apps/manual/engine.md.
#pragma once
#include <string>
#include <vector>

#include "apps/bake/texture_file.h"
#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

enum class TextureFormat { none, ktx2, dds, exr };

struct EnvironmentTextures {
    std::vector<std::string> files;    // paths, in the order written
    std::vector<std::string> warnings; // one line each: values that half floats cannot hold
};

// Into a folder that is there: specular, box, irradiance and, with extracted lights, whole; dfg, lobe_albedo and ltc; key_lights.json and
// key_lights.glsl. An .exr holds one face of one level, or a table. Errors: ExitCode::output_failed.
Result<EnvironmentTextures> write_environment_textures(const std::string& folder, const Environment& environment, const DfgTable& dfg,
                                                       TextureFormat format, TexelType type, const Jobs& jobs);

} // namespace burnish
