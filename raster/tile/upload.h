// From the shared tables to the plain data that the lanes read: materials, texture pyramids, lights, cubes, sample patterns.
#pragma once
#include <memory>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "raster/tile/tile_types.h"
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

// The n x n samples of filtered importance sampling, n = floor(sqrt(samples)): Gaussian slopes (Beckmann) or GGX.
std::vector<GridSample> grid_samples(int samples, bool ggx);

CubeParams cube_params(const CubeMap& cube);
ViewParams view_params_of(const View& view);
SamplePattern standard_samples(int count); // Vulkan's standard sample locations for 1, 2, 4, 8, 16

} // namespace burnish
