// From the shared tables to the plain data of shading/lang: materials, texture pyramids, lights, sample patterns.
#pragma once
#include <memory>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/tables.h"

namespace burnish {

struct SceneTables { // keeps alive what the records point at
    std::vector<TexturePyramid> pyramids;
    std::vector<TextureParams> textures;
    std::vector<MaterialRecord> materials;
    std::vector<MaterialRecord> overridden; // for frames that override(): with other textures
    std::vector<LightRecord> lights;
    std::vector<float> light_columns; // FrameTables
    int light_stride = 0;
    std::vector<AreaLightRecord> area_lights;
};

// Textures are numbered as in SceneTables::textures. A material that blends, whose alpha is 1 everywhere, is opaque.
std::vector<MaterialRecord> material_records(const Scene& scene, const SceneMips& mips, bool overridden);
bool any_blends(const std::vector<MaterialRecord>& materials); // whether a material's alpha mode is kAlpha_blend
std::vector<LightRecord> light_records(const DrawTables& tables);
std::vector<AreaLightRecord> area_light_records(const DrawTables& tables); // their pictures: textures of the scene

// Builds every texture pyramid that a material uses (pyramids.h) and the pictures of area lights, in parallel.
SceneTables upload_scene(const Scene& scene, const SceneMips& mips, const DrawTables& tables, const Jobs& jobs);

// Whether the lobes of any material are tilted against their surfaces in the frame.
bool tilts(const Scene& scene, const FrameDesc& desc);
// check_desc(), and whether the frame's lobes can be tilted where the scene's are.
Status check_frame(const Scene& scene, const FrameDesc& desc);

// Roughness or anisotropy of materials, or normal maps that lobes were filtered with.
bool overrides(const Scene& scene, const SceneMips& mips, const FrameDesc& desc);
// Those of SceneTables that the frame takes, with its overrides, and tilted.
std::vector<MaterialRecord> in_frame(std::vector<MaterialRecord> materials, const FrameDesc& desc);

TextureParams texture_params(const TexturePyramid& pyramid);
SamplePattern standard_samples(int count);        // Vulkan's standard sample locations for 1, 2, 4, 8, 16
int central_sample(const SamplePattern& pattern); // the first of those nearest to the pixel's centre

} // namespace burnish
