// What the Vulkan stages read and write, one text for C++ and GLSL: structures of 32-bit scalars and arrays of them, which std430 and
// C++ lay out alike. Tables that kernels index (positions, vertices, levels, grids) lie in the flat buffers of the kernel language
// and are named here by the index of their first element.
#ifndef BN_GPU_RECORDS_H
#define BN_GPU_RECORDS_H

#include "shading/lang/recorded.h"
#include "shading/lang/records.h"

#ifdef __cplusplus
namespace burnish {
#endif

const int kGpuCubes = 4, kGpuGroup = 64; // cubes, invocations a workgroup
// Pages of texels; textures follow. In the reals the grid of filtered importance sampling comes first, 3 a sample.
const int kGpuSpecularPage = 0, kGpuIrradiancePage = 1, kGpuBoxPage = 2, kGpuDfgPage = 3, kGpuLobeAlbedoPage = 4, kGpuLobeSlicePage = 5,
          kGpuWholePage = 6, kGpuLtcPage = 7, kGpuFirstTexturePage = 8;
const int kGpuMaxGrid = 262144; // kMostGridSamples
const int kGpuNoTriangle = -1;
const int kGpuFirstAreaWay = 16; // bit of a stage's constant 1; lobes have those below
const int kGpuCoatBit = 24;      // of the same constant: some material has a clear coat
// The rasterizer's viewport is twice as many pixels wide, around the centre pixel, or as wide as the device allows: a power of two, so
// every snapped position survives the driver's arithmetic, and no whole triangle leaves a guard band of the same width on either side.
const int kGpuViewportHalf = 8192;

const int kGpuRecordStages = 1, kGpuRecordLayers = 2, kGpuRecordColors = 4; // bits of what a band records: stages/records.glsl
// Surfaces of a pass: opaque and masked ones; the next layer of blended ones; all, the blended ones where alpha is above a half.
const int kGpuSolid = 0, kGpuLayer = 1, kGpuAll = 2;
// Words of a sample in BnPeel; stages/peel.glsl names their places. The last one says, of a pixel's first sample, whether the pixel shows a
// layer.
const int kGpuPeelWords = 12;
const int kGpuLineWords = 16; // line_record (shading/techniques/shared_line.k.h)
// The forward pipeline records a sample's words four at a time, as colours: 0 triangle ids, then interpolants and material inputs, then
// colour.
const int kGpuForwardGroups = 1 + (kInterpolantWords + kMaterialWords + 3) / 4, kGpuColorGroup = kGpuForwardGroups;

// Where a stage finds what lies in the buffers, and what the device alone needs to know.
struct GpuPlaces {
    int triangle_count, vertex_count, setup_capacity;
    int position_base[3], shading_base; // into the reals: a column each; 16 a vertex
    int index_base, material_base;      // into the integers: 3 a triangle; 1 a triangle
    float clip_unit;                    // 1/256 pixel in clip space of the rasterizer's viewport
};

struct GpuFrame {
    FrameRecord frame;
    GpuPlaces places;
};

struct GpuTexture {
    int page, levels, wrap_s, wrap_t, nearest;
    int offset_base, width_base, height_base; // 16 each, into the integers, the reals, the reals
};

struct GpuVertex {
    float clip[4]; // x, y, w, z
    int x, y;      // snapped; x = kNeedsClip where there is no such position
    float inv_w, z;
};

// A whole triangle, or a piece of one that was clipped. Vertices run so that the area is positive with y down.
struct GpuSetup {
    int x[3], y[3];
    float inv_w[3], z[3];
    int vertex[3]; // of the whole triangle
    int info;      // material << 2 | kFrontFacing | kClipped
    int triangle;
    float bary[9]; // of a piece: corner j = sum_k bary[3j+k] * vertex k
};

struct GpuDraw { // VkDrawIndirectCommand, how many setups there are, and (pixel, triangle) pairs of the last blended layer
    int vertex_count, instance_count, first_vertex, first_instance, setups, peeled;
};

// Push constants. Large pictures are drawn in bands of rows; images and buffers of the size of a picture hold one band.
struct GpuPass {
    int shift_x, shift_y;         // of passes that take one sample of several: where it lies, as a shift to the pixel's centre, 1/256 pixel
    int sample_number;            // and its number; -1 where the device itself takes all samples
    int material, first_triangle; // of a draw of the forward pipeline
    int first_row, rows;          // the band
    int group;                    // of recorded words, see kGpuForwardGroups
    int surfaces;                 // that a pass of visibility draws: kGpuSolid...
};

#ifdef __cplusplus
}
#endif

#endif
