// The inner loops of FLIP as lane code: one copy an instruction set, all with the same bits. A picture is
// worked on in tiles; of a tile, rows are made ready, filtered along x into a ring of rows, and finished by
// the filters along y. Plain pointers only: the instruction-set objects see no containers.
#pragma once
#include "core/simd/fns.h"

namespace burnish {

// Half kernels, [0] at the centre and [k] at distance k. All are even but `edge`, which is odd: +[k] at
// x + k, -[k] at x - k. The kernel of Cz is a sum of two Gaussians, each of them separable.
struct FlipFilters {
    int y_radius = 0; // of y, gauss, edge and point
    int cx_radius = 0, cz_radius = 0;
    const float *y, *cx;               // contrast sensitivity: achromatic and red-green
    const float *cz, *cz2;             // blue-yellow: the two terms
    const float *gauss, *edge, *point; // features: Gaussian, its first and its second derivative
    float max_difference;              // the largest colour difference, to which errors are scaled
};

// Planes of a filtered row: Y, Cx and both terms of Cz; the Y row under gauss, edge and point.
enum FlipPlane { kFlipY, kFlipCx, kFlipCz, kFlipCz2, kFlipGauss, kFlipEdge, kFlipPoint, kFlipPlanes };

// Rows that are finished at once: each filtered row is then loaded once for all of them.
inline constexpr int kFlipRows = 4;

struct FlipTone {
    enum Curve { none, rational, reinhard } curve = none;
    float scale = 1.0f; // 2^exposure
    float c[6] = {};    // rational: (c0 x^2 + c1 x + c2) / (c3 x^2 + c4 x + c5)
};

// Row buffers are readable and writable up to the next multiple of 16 floats.
struct FlipFns {
    // n pixels of linear Rec.709, planes R, G, B `stride` apart, are exposed, tonemapped, clamped to [0,1] and become planes Y, Cx, Cz.
    void (*prepare)(const FlipTone& tone, int n, int stride, const float* linear, float* out);
    // Filters n values of a row along x. The inputs are readable for the radius on either side; plane i goes
    // to out + i * stride.
    void (*filter)(const FlipFilters& filters, const float* y, const float* cx, const float* cz, int n, int stride, float* out);
    // rows[radius + k], k in [-radius, radius + kFlipRows - 1]: filtered rows around the first of the kFlipRows rows to finish, planes of
    // the reference, then of the test. Writes n errors to each of error[0..count - 1], or with `keep_larger` the larger of those and what
    // is there.
    void (*finish)(const FlipFilters& filters, const float* const* rows, int radius, int stride, int n, bool keep_larger,
                   float* const* error, int count);
};

BN_DECLARE_FNS(FlipFns);

} // namespace burnish
