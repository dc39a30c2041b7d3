// Records that the Vulkan stages read and write. One text for C++ and GLSL: structs and arrays of 32-bit scalars, which
// std430 and C++ lay out alike. Tables that kernels index (positions, vertices, levels, grids) lie in the kernel language's
// flat buffers. The records name a table by the index of its first element.
#ifndef BN_GPU_RECORDS_H
#define BN_GPU_RECORDS_H

#include "shading/lang/recorded.h"
#include "shading/lang/records.h"

#ifdef __cplusplus
namespace burnish {
#endif

const int kGpuCubes = 4, kGpuGroup = 64; // cubes; invocations per workgroup
// Texel pages; textures follow them. The buffer of reals starts with the grid of sample slopes, 3 reals per sample.
const int kGpuSpecularPage = 0, kGpuIrradiancePage = 1, kGpuBoxPage = 2, kGpuDfgPage = 3, kGpuLobeAlbedoPage = 4, kGpuLobeSlicePage = 5,
          kGpuWholePage = 6, kGpuLtcPage = 7, kGpuFirstTexturePage = 8;
const int kGpuMaxGrid = 262144; // kMostGridSamples
const int kGpuNoTriangle = -1;
const int kGpuFirstAreaWay = 16; // first bit for area-light methods in specialization constant 1; lobes have the bits below
const int kGpuTransmits = 23;    // bit of the same constant where some material transmits light
const int kGpuFirstCoating = 24; // first bit of the same constant for coatings that some material has
const int kGpuFilms = 30;        // bit of the same constant where some material lies under a thin film
// The rasterizer's viewport is twice this many pixels wide around the centre pixel, or as wide as the device allows. The
// width is a power of two, so every snapped position survives the driver's arithmetic. No whole triangle leaves a guard
// band of the same width on either side.
const int kGpuViewportHalf = 8192;

const int kGpuRecordStages = 1, kGpuRecordLayers = 2, kGpuRecordColors = 4; // bits of a band's recorded parts: stages/records.glsl
// Surfaces of a pass: opaque and masked ones; the next layer of blended ones; all, with blended ones where alpha exceeds a
// half.
const int kGpuSolid = 0, kGpuLayer = 1, kGpuAll = 2;
// Words per sample in BnPeel; stages/peel.glsl names them. For a pixel's first sample, the last word says if the pixel
// shows a layer.
const int kGpuPeelWords = 12;
const int kGpuSharedSampleWords = 16; // shared_sample_record (shading/techniques/shared_samples.k.h)
// The forward pipeline records a sample's words in groups of four, as colours: group 0 holds triangle ids, then
// interpolants and material inputs, then colour.
const int kGpuForwardGroups = 1 + (kInterpolantWords + kMaterialWords + 3) / 4, kGpuColorGroup = kGpuForwardGroups;

// Offsets of tables in the buffers, and numbers that only the device needs.
struct GpuPlaces {
    int triangle_count, vertex_count, setup_capacity;
    int position_base[3], shading_base; // into the reals: one per column; 16 reals per vertex
    int index_base, material_base;      // into the integers: 3 per triangle; 1 per triangle
    float clip_unit;                    // 1/256 pixel in clip space of the rasterizer's viewport
};

struct GpuFrame {
    FrameRecord frame;
    GpuPlaces places;
};

struct GpuTexture {
    int page, levels, wrap_s, wrap_t, nearest;
    int offset_base, width_base, height_base; // 16 entries each: into the integers, the reals, the reals
};

struct GpuVertex {
    float clip[4]; // x, y, w, z
    int x, y;      // snapped; x = kNeedsClip where no snapped position exists
    float inv_w, z;
};

// A whole triangle, or a piece of a clipped one. The vertex order makes the area positive with y down.
struct GpuSetup {
    int x[3], y[3];
    float inv_w[3], z[3];
    int vertex[3]; // the whole triangle's
    int info;      // material << 2 | kFrontFacing | kClipped
    int triangle;
    float bary[9]; // for a piece: corner j = sum_k bary[3j+k] * vertex k
};

// VkDrawIndirectCommand; number of setups; (pixel, triangle) pairs in the last blended layer, and those in the band's own
// rows.
struct GpuDraw {
    int vertex_count, instance_count, first_vertex, first_instance, setups, peeled, peeled_own;
};

// Push constants. Large pictures are drawn in bands of rows; picture-sized images and buffers hold one band.
struct GpuPass {
    int shift_x, shift_y;         // in passes for one sample of several: the sample's offset from the pixel centre, 1/256 pixel
    int sample_number;            // the sample's number; -1 where the device takes all samples itself
    int material, first_triangle; // of one draw in the forward pipeline
    int first_row, rows;          // the band
    int group;                    // of recorded words, see kGpuForwardGroups; setup.comp counts in 0 and writes in 1
    int surfaces;                 // surfaces that a visibility pass draws: kGpuSolid...
    int own_begin, own_end;       // for compose.comp: the band's own rows among those drawn
};

#ifdef __cplusplus
}
#endif

#endif
