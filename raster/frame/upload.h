// From the shared tables to the plain data of records.h: materials, texture pyramids, lights, cubes, sample patterns.
#pragma once
#include <memory>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "raster/frame/records.h"
#include "shading/bake/texture.h"

namespace burnish {

struct SceneTables { // keeps alive what the records point at
    std::vector<TexturePyramid> pyramids;
    std::vector<TextureParams> textures;
    std::vector<MaterialRecord> materials;
    std::vector<LightRecord> lights;
};

// Builds every texture pyramid that a material uses, once a (texture, encoding) pair, in parallel.
SceneTables upload_scene(const Scene& scene, const DrawTables& tables, const Jobs& jobs);

// With the frame's overrides of roughness and anisotropy.
std::vector<MaterialRecord> overridden(std::vector<MaterialRecord> materials, const FrameDesc& desc);

CubeParams cube_params(const CubeMap& cube);
TextureParams texture_params(const TexturePyramid& pyramid);
ViewParams view_params_of(const View& view);
SamplePattern standard_samples(int count); // Vulkan's standard sample locations for 1, 2, 4, 8, 16

} // namespace burnish
