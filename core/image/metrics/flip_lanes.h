// FLIP's inner loops as lane code: one copy for each instruction set, all with equal bits. FLIP works on tiles. It
// prepares a tile's rows, filters them along x into a row ring, and finishes with filters along y. Plain pointers
// only, because lane code sees no containers.
#pragma once
#include "core/simd/fns.h"

namespace burnish {

// Half kernels, [0] at the centre and [k] at distance k. All are even except `edge`, which is odd: +[k] at x + k, -[k]
// at x - k. Cz's kernel sums two separable Gaussians.
struct FlipFilters {
    int y_radius = 0; // radius for y, gauss, edge and point
    int cx_radius = 0, cz_radius = 0;
    const float *y, *cx;               // contrast sensitivity: achromatic and red-green
    const float *cz, *cz2;             // blue-yellow: the two terms
    const float *gauss, *edge, *point; // features: Gaussian, its first and its second derivative
    float max_difference;              // largest colour difference; scales errors to [0,1]
};

// A filtered row's planes: Y, Cx, Cz's two terms, and Y filtered by gauss, edge and point.
enum FlipPlane { kFlipY, kFlipCx, kFlipCz, kFlipCz2, kFlipGauss, kFlipEdge, kFlipPoint, kFlipPlanes };

// Rows finished together: one load of a filtered row then serves all of them.
inline constexpr int kFlipRows = 4;

struct FlipTone {
    enum Curve { none, rational, reinhard } curve = none;
    float scale = 1.0f; // 2^exposure
    float c[6] = {};    // rational: (c0 x^2 + c1 x + c2) / (c3 x^2 + c4 x + c5)
};

// Row buffers are readable and writable up to the next multiple of 16 floats.
struct FlipFns {
    // Exposes, tonemaps and clamps to [0,1] n pixels in linear Rec.709, and converts them to Y, Cx, Cz. Planes lie
    // `stride` apart.
    void (*prepare)(const FlipTone& tone, int n, int stride, const float* linear, float* out);
    // Filters n values in a row along x. The inputs are readable for the radius on either side. Plane i goes to out + i
    // * stride.
    void (*filter)(const FlipFilters& filters, const float* y, const float* cx, const float* cz, int n, int stride, float* out);
    // Writes n errors to each of error[0..count - 1]; with `keep_larger`, keeps the larger error, old or new.
    // rows[radius + k], k in [-radius, radius + kFlipRows - 1], are filtered rows around the first finished row. Each
    // row holds the reference's planes, then the test's.
    void (*finish)(const FlipFilters& filters, const float* const* rows, int radius, int stride, int n, bool keep_larger,
                   float* const* error, int count);
};

BN_DECLARE_FNS(FlipFns);

} // namespace burnish
