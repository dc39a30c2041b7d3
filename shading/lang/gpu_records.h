// What the Vulkan stages read and write, one text for C++ and GLSL: structures of 32-bit scalars and arrays of them, which std430 and
// C++ lay out alike. Tables that kernels index (positions, vertices, levels, grids) lie in the flat buffers of the kernel language
// and are named here by the index of their first element.
#ifndef BN_GPU_RECORDS_H
#define BN_GPU_RECORDS_H

#ifdef __cplusplus
namespace burnish {
#endif

const int kGpuSamples = 16, kGpuTextureSlots = 11, kGpuCubes = 3, kGpuGroup = 64; // samples a pixel, textures a material, cubes, invocations a workgroup
const int kGpuNoTriangle = -1;
const int kGpuFrontFacing = 1, kGpuClipped = 2;                    // bits of GpuSetup.info
const int kGpuWholeBand = 3932160, kGpuCutPixels = 15872, kGpuGuardBand = 4194304; // as raster/tile/tile_types.h; cut band in pixels
const int kGpuNeedsClip = -1073741824;
// The rasterizer's viewport is twice as many pixels wide, around the centre pixel, or as wide as the device allows: a power of two, so every
// snapped position survives the driver's arithmetic, and no whole triangle leaves a guard band of the same width on either side.
const int kGpuViewportHalf = 8192;

// Words that a recorded stage takes a visible (pixel, triangle) pair.
const int kGpuInterpolantWords = 30, kGpuMaterialWords = 23, kGpuPairWords = 57; // mask, interpolants, material inputs, colour
// The forward pipeline records a sample's words four at a time, as colours: 0 triangle ids, then interpolants and material inputs, then colour.
const int kGpuForwardGroups = 15, kGpuColorGroup = 15;

struct GpuCube {
    int page, size, levels;
    float scale;
};

struct GpuFrame {
    float eye[3], right[3], up[3], forward[3];
    float inv_tan_x, inv_tan_y, znear, inv_depth, zfar;
    int orthographic;
    int width, height, msaa, center_x, center_y; // center: 1/256 pixel
    float half_width, half_height;
    float clip_unit; // 1/256 pixel in clip space of the rasterizer's viewport
    int sample_x[kGpuSamples], sample_y[kGpuSamples]; // 1/256 pixel
    int sample_min_x, sample_max_x, sample_min_y, sample_max_y;
    int triangle_count, vertex_count, setup_capacity;
    int position_base[3], shading_base; // into the reals: a column each; 16 a vertex
    int index_base, material_base;      // into the integers: 3 a triangle; 1 a triangle
    GpuCube specular, irradiance, box;
    int grid_base, grid_count;          // into the reals: 3 a sample
    int dfg_page, dfg_size, lobe_albedo_page, lobe_albedo_size, dfg_fit, energy_compensation, horizon;
    int background, samples, texture_taps, seed;
    float tilt_cos[2], tilt_sin[2];
    int tilted;
    float major_axis_k, major_axis_beta;
    int override_anisotropy;
    float anisotropy;
    int light_count;
};

struct GpuBinding {
    int texture, uv_set; // texture: -1 not used
    float transform[6];  // u' = t0 u + t2 v + t4, v' = t1 u + t3 v + t5
};

struct GpuMaterial { // MaterialRecord
    float base_color[4], emissive[3];
    float metallic, roughness, normal_scale, occlusion_strength;
    float dielectric_f0[3], dielectric_f90;
    float alpha_cutoff;
    int alpha_mode, double_sided, unlit, textured, uses_color, anisotropic, roughness_fixed;
    float anisotropy_strength, anisotropy_rotation[2];
    GpuBinding textures[kGpuTextureSlots];
};

struct GpuTexture {
    int page, levels, wrap_s, wrap_t, nearest;
    int offset_base, width_base, height_base; // 16 each, into the integers, the reals, the reals
};

struct GpuLight { // LightRecord
    float position[3], direction[3], radiant[3];
    float inv_range2, spot_scale, spot_offset;
    int directional;
};

struct GpuVertex {
    float clip[4]; // x, y, w, z
    int x, y;      // snapped; x = kGpuNeedsClip where there is no such position
    float inv_w, z;
};

// A whole triangle, or a piece of one that was clipped. Vertices run so that the area is positive with y down.
struct GpuSetup {
    int x[3], y[3];
    float inv_w[3], z[3];
    int vertex[3];  // of the whole triangle
    int info;       // material << 2 | kGpuFrontFacing | kGpuClipped
    int triangle;
    float bary[9];  // of a piece: corner j = sum_k bary[3j+k] * vertex k
};

struct GpuDraw { // VkDrawIndirectCommand, and how many setups there are
    int vertex_count, instance_count, first_vertex, first_instance, setups;
};

// Push constants. Large pictures are drawn in bands of rows; images and buffers of the size of a picture hold one band.
struct GpuPass {
    int shift_x, shift_y; // of passes that take one sample of several: where it lies, as a shift to the pixel's centre, 1/256 pixel
    int sample_number;    // and its number; -1 where the device itself takes all samples
    int material, first_triangle; // of a draw of the forward pipeline
    int first_row, rows;  // the band
    int group;            // of recorded words, see kGpuForwardGroups
};

#ifdef __cplusplus
}
#endif

#endif
