// Converts the shared tables to plain data for shading/lang: materials, texture pyramids, lights, sample patterns.
#pragma once
#include <memory>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/tables.h"

namespace burnish {

struct KeptWeights;

struct SceneTables { // owns the data that the records point to
    std::vector<std::shared_ptr<const TexturePyramid>> pyramids;
    std::vector<TextureParams> textures;
    std::vector<MaterialRecord> materials;
    std::vector<MaterialRecord> overridden; // for frames that override(): with other textures
    std::vector<LightRecord> lights;
    std::vector<float> light_columns; // FrameTables
    int light_stride = 0;
    std::vector<AreaLightRecord> area_lights;
};

// Textures are numbered as in SceneTables::textures. A material that blends, whose alpha is 1 everywhere, is opaque.
// kept: kept_weights_by_material().
std::vector<MaterialRecord> material_records(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept,
                                             bool overridden);
bool any_blends(const std::vector<MaterialRecord>& materials); // whether a material's alpha mode is kAlpha_blend
std::vector<LightRecord> light_records(const DrawTables& tables);
std::vector<AreaLightRecord> area_light_records(const DrawTables& tables); // pictures are texture indices of the scene

// Builds the texture pyramids that materials use in the frames that `mips` allows, and the pictures of area lights, in parallel.
// Pyramids that input.pyramids keeps are taken from there.
SceneTables upload_scene(const RenderInput& input);

// Returns true if the frame tilts any material's lobes against their surfaces.
bool tilts(const Scene& scene, const FrameDesc& desc);
// Runs check_desc(). Checks that the frame's lobes can be tilted if the scene tilts them.
Status check_frame(const Scene& scene, const FrameDesc& desc);
// Returns true where a frame sets roughness or anisotropy, or leaves normal maps out: it overrides materials.
bool sets_materials(const FrameDesc& desc);
// Refuses a frame that sets_materials() where the scene was prepared without (MipSettings::frames_override).
Status check_prepared(const SceneMips& mips, const FrameDesc& desc);

// Roughness or anisotropy of materials, or normal maps that lobes were filtered with.
bool overrides(const Scene& scene, const SceneMips& mips, const FrameDesc& desc);
// Returns the materials as the frame takes them: with its overrides, and tilted. materials: of SceneTables.
std::vector<MaterialRecord> in_frame(std::vector<MaterialRecord> materials, const FrameDesc& desc);

TextureParams texture_params(const TexturePyramid& pyramid);
SamplePattern standard_samples(int count);        // Vulkan's standard sample locations for 1, 2, 4, 8, 16 samples
int central_sample(const SamplePattern& pattern); // the sample nearest to the pixel centre; the first one on a tie

} // namespace burnish
