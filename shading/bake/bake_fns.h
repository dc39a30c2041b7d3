// Lane code for the two integrals over the sphere that dominate a bake. Each lane holds a texel and adds its terms in list order. So the
// bits depend neither on the lane width nor on the work's split. Interfaces use plain pointers, because instruction-set objects may not
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

inline constexpr int kPrefilterBlock = 4; // edge texels in a block that shares its terms

struct IrradianceInput {
    const float *x, *y, *z; // the unit direction's integrals over source texels
    const float *r, *g, *b; // radiance
    int count, row;         // texel count; texels per partial sum
};

struct BakeFns { // work on one face of size x size, a power of two
    // Writes RGB for the block whose first texel is (x, y), row by row. The block has kPrefilterBlock^2 texels, or the whole face if that
    // is smaller. Each texel is the terms' mean under GGX with V = N = R, weighted by n.l.
    void (*prefilter)(const PrefilterInput& input, int face, int size, int x, int y, float* rgb);
    // Writes `count` RGB texels from `first` on (row-major): the cosine-weighted mean radiance.
    void (*irradiance)(const IrradianceInput& input, int face, int size, int first, int count, float* rgb);
};

BN_DECLARE_FNS(BakeFns);

// A light tree's level (environment/light_tree.h). A texel's four parts in the next coarser level form a quad. Quads follow each
// other as those texels do, face by face and row-major.
struct LightLevel {
    int size;             // texels along a face's edge
    const double* angles; // sr, by quad, for one face; all faces are alike
    const float* places;  // by quad, then the four parts' x, the four y, the four z: the light's mean directions, unit; null: the
                          // texels' centres
    const float* rgb;     // radiance, row-major
};

// Terms in the tree's order, with marks where tree parts are still to be walked.
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

inline constexpr int kMostLightLevels = 14; // in a tree: a cube with 4096 texels, and one more

// Texels that share a walk. Chords stand for angles. With d as a light's distance to the centre, the distance to each block lies
// between d - nearer and d - farther; below 0 it counts as 0.
struct GatherInput {
    const LightLevel* levels; // finest first
    double centre[3];         // unit
    double nearer, farther;   // farther may be negative
    double width2;            // the lobe's squared width
    double opening2;          // squared opening; see gather_terms()
    double farthest2;         // no piece is larger than it would be at this squared distance
};

struct LightTreeFns {
    // Copies the terms from `from`, and walks the parts that it marks. Writes new marks for parts that some blocks take and others open.
    // There are none if nearer and farther are equal. Returns false if `to` is too short.
    bool (*gather)(const GatherInput& input, const GatherList& from, GatherList& to);
};

BN_DECLARE_FNS(LightTreeFns);

} // namespace burnish
