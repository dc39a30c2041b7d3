// Scene tables as plain data, and a frame with its tables. Lanes of any instruction set read them, and every renderer's
// shading starts from them. raster/frame fills them. C++ only: tables hold pointers beside the records.
#pragma once
#include <cstdint>

#include "shading/lang/records.h"

namespace burnish {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct TextureParams { // TexturePyramid as plain data
    const std::uint16_t* texels;
    std::int32_t width, height, levels, wrap_s, wrap_t, nearest;
    std::int32_t offset[16];
    float level_width[16], level_height[16];
};

enum TextureSlot {
#define BN_SLOT(slot, at, texture, encoding, power) slot = at,
#include "core/scene/material.def"
};

// Returns the sum of a lobe's traits: those in its line, its kLies_ and its kNormals_ bit.
constexpr int lobe_traits_of(int lobe)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe == at)                                                                                                                        \
        return (traits) + kLies_##lies + kNormals_##normals;
#include "shading/models.def"
    return 0;
}

// Returns the index of the first lobe in shading/models.def that has the trait.
constexpr int lobe_with(int trait)
{
    int lobe = 0;
    while (!(lobe_traits_of(lobe) & trait))
        ++lobe;
    return lobe;
}

// One sample of a unit lobe (widths 1): slopes, and the density of normals there times h.z^4.
struct GridSample { // with kPhongGrid: see as_mc.t.h
    float slope_x, slope_y, density;
};

inline constexpr int kMostGridSamples = 1 << 18; // per frame: samples of a technique, and half vectors of lobes

// The parts of a frame that its record does not hold. Pointers are null where nothing reads them.
struct FrameTables {
    const float *screen_x, *screen_y; // place_on_screen() of pixel centres, by column and by row; 16 entries are readable from each
    const float *px, *py, *pz;        // by vertex; world space, metres
    const float* shading_vertices;    // DrawTables::shading as floats, 16 per vertex
    const std::uint32_t* indices;
    const std::uint32_t* triangle_material;
    const MaterialRecord* materials;
    const TextureParams* textures;
    const LightRecord* lights;
    const float* light_columns; // the same lights in columns x, y, z, inv_range2, light_stride floats each; a full register is readable
                                // from any light
    int light_stride;
    const AreaLightRecord* area_lights;
    const std::uint16_t *specular_texels, *irradiance_texels, *whole_texels, *box_texels; // CubeMap::texels
    const float *dfg_pairs, *lobe_albedo_pairs, *lobe_slice_pairs; // DfgTable::pairs, bake_lobe_albedo(), bake_lobe_slice()
    const std::uint16_t* ltc_texels;                               // ltc::table_texels()
    const GridSample* grid;
};

struct ShadingFrame : FrameRecord, FrameTables {};

} // namespace burnish
