// Lane code of the two integrals over the sphere that dominate a bake. Each lane holds a texel and adds its terms in list order. So the
// bits depend neither on the lane width nor on the split of work. Interfaces use plain pointers, because instruction-set objects may not
// use containers.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

struct PrefilterTerm { // light from one place
    float x, y, z;     // unit direction
    float angle;       // sr
    float r, g, b;     // radiance times solid angle
};

struct PrefilterInput {
    const PrefilterTerm* terms;
    int count;
    float alpha; // GGX width, (0,1]
};

inline constexpr int kPrefilterBlock = 4; // texels along an edge of a block that shares its terms

struct IrradianceInput {
    const float *x, *y, *z; // integrals of the unit direction over source texels
    const float *r, *g, *b; // radiance
    int count, row;         // number of texels; texels per partial sum
};

struct BakeFns { // work on one face of size x size, a power of two
    // Writes RGB of the block whose first texel is (x, y), row by row. The block has kPrefilterBlock^2 texels, or the whole face if that
    // is smaller. Each texel is the mean of the terms under GGX with V = N = R, weighted by n.l.
    void (*prefilter)(const PrefilterInput& input, int face, int size, int x, int y, float* rgb);
    // Writes `count` RGB texels from `first` on (row-major): the cosine-weighted mean radiance.
    void (*irradiance)(const IrradianceInput& input, int face, int size, int first, int count, float* rgb);
};

BN_DECLARE_FNS(BakeFns);

// One level of a light tree (environment/light_tree.h). The four parts of a texel in the next coarser level form a quad. Quads follow each
// other as those texels do, face by face and row-major.
struct LightLevel {
    int size;             // texels along an edge of a face
    const double* angles; // sr, by quad, of one face; all faces are alike
    const float* places;  // by quad, then x of the four parts, y of the four, z of the four: the light's mean directions, unit; null: the
                          // texels' centres
    const float* rgb;     // radiance, row-major
};

// Terms in the order of the tree, with marks where parts of it are still to be walked.
struct GatherMark {
    int term;        // the first term behind the part
    int face, level; // the texel whose parts are meant
    int x, y;
    int first, end; // its parts, [0,4]
};
struct GatherList {
    PrefilterTerm* terms;
    GatherMark* marks;
    int term_count, mark_count, most_terms, most_marks;
};

inline constexpr int kMostLightLevels = 14; // of a tree: a cube of 4096 texels, and one more

// Texels that share a walk. Chords stand for angles. With d as the distance of a light to the centre, the distance to each block lies
// between d - nearer and d - farther; below 0 it counts as 0.
struct GatherInput {
    const LightLevel* levels; // finest first
    double centre[3];         // unit
    double nearer, farther;   // farther may be negative
    double width2;            // squared width of the lobe
    double opening2;          // squared opening; see gather_terms()
    double farthest2;         // no piece is larger than it would be at this squared distance
};

struct LightTreeFns {
    // Copies the terms of `from`, and walks the parts that it marks. Writes new marks for parts that some blocks take and others open.
    // There are none if nearer and farther are equal. Returns false if `to` is too short.
    bool (*gather)(const GatherInput& input, const GatherList& from, GatherList& to);
};

BN_DECLARE_FNS(LightTreeFns);

} // namespace burnish
