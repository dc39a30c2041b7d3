// Materials, textures, lights, cubes and views as plain data: what lanes of any instruction set read, and what every renderer's shading
// is made from. upload.h fills them.
#pragma once
#include <cstdint>

namespace burnish {

inline constexpr int kSubpixel = 256;                // sub-pixel units a pixel
inline constexpr int kMaxSamples = 16;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct ViewParams { // Renderer's View in plain numbers
    float eye[3], right[3], up[3], forward[3];
    float inv_tan_x, inv_tan_y; // perspective: 1/tan of the half angles; orthographic: 1/half extents
    float znear, inv_depth;     // inv_depth: 1/(far - near), orthographic only
    float zfar;
    std::int32_t orthographic;
};

struct SamplePattern { // Vulkan's standard sample locations in sub-pixel units from the pixel's top left corner
    std::int32_t count;
    std::int32_t x[kMaxSamples], y[kMaxSamples];
    std::int32_t x16[kMaxSamples], y16[kMaxSamples]; // the same in units of 16, which all of them are multiples of
    std::int32_t min_x, max_x, min_y, max_y;
};

struct CubeParams { // CubeMap in plain data
    const std::uint16_t* texels;
    std::int32_t size, levels;
    std::int32_t offset[16]; // by level, of face 0, in texels
    float scale;
};

struct TextureParams { // TexturePyramid in plain data
    const std::uint16_t* texels;
    std::int32_t width, height, levels, wrap_s, wrap_t, nearest;
    std::int32_t offset[16];
    float level_width[16], level_height[16];
};

enum TextureSlot { kBaseColorTex, kMetalRoughTex, kNormalTex, kOcclusionTex, kEmissiveTex, kSpecularTex, kSpecularColorTex,
                   kTensor2Tex, kTensor4Tex, kTensor2RestTex, kTensor4RestTex, kTextureSlots };

struct TextureBinding {
    const TextureParams* texture; // null: not used
    std::int32_t uv_set;
    float transform[6];       // u' = t0 u + t2 v + t4, v' = t1 u + t3 v + t5
};

struct MaterialRecord {
    float base_color[4];
    float emissive[3];
    float metallic, roughness;
    float normal_scale, occlusion_strength;
    float dielectric_f0[3], dielectric_f90; // from ior and specular
    float alpha_cutoff;
    std::int32_t alpha_mode;  // AlphaMode
    std::int32_t double_sided, unlit, textured, uses_color, anisotropic;
    std::int32_t roughness_fixed; // by an override: the texture gives metalness only
    float anisotropy_strength, anisotropy_rotation[2]; // rotation: cosine and sine
    TextureBinding textures[kTextureSlots];
};

struct LightRecord { // DrawTables' PunctualLight in plain numbers
    float position[3], direction[3], radiant[3];
    float inv_range2, spot_scale, spot_offset;
    std::int32_t directional;
};

// One sample of a unit lobe (widths 1): its slopes, and the density of normals there times h.z^4.
struct GridSample {
    float slope_x, slope_y, density;
};

} // namespace burnish
