// FLIP for pixels, after Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images", sections 4.1 to 4.3. Filters are separated as in the authors' note "Separated
// convolutions" (2021).
#include "core/image/metrics/flip_lanes.h"
#include "core/simd/lanes.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

struct Triple {
    real x, y, z;
};

// Linear Rec.709 to XYZ relative to the white point, whose X and Z (Y = 1) are FLIP's values for D65.
constexpr double kWhiteX = 0.950428545, kWhiteZ = 1.088900371;
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794.0 / kWhiteX, 8788810.0 / 24577794.0 / kWhiteX, 4435075.0 / 24577794.0 / kWhiteX},
                                 {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
                                 {1425312.0 / 73733382.0 / kWhiteZ, 8788810.0 / 73733382.0 / kWhiteZ, 70074185.0 / 73733382.0 / kWhiteZ}};
constexpr double kToRgb[3][3] = {{3.241003275 * kWhiteX, -1.537398934, -0.498615861 * kWhiteZ},
                                 {-0.969224334 * kWhiteX, 1.875930071, 0.041554224 * kWhiteZ},
                                 {0.055639423 * kWhiteX, -0.204011202, 1.057148933 * kWhiteZ}};
// Clamp for radiance, so that its square is finite. Every tone curve is flat there.
constexpr double kBrightest = 1e15;

BN_INLINE Triple times(const double (&m)[3][3], Triple v)
{
    return {lit(m[0][0]) * v.x + lit(m[0][1]) * v.y + lit(m[0][2]) * v.z, lit(m[1][0]) * v.x + lit(m[1][1]) * v.y + lit(m[1][2]) * v.z,
            lit(m[2][0]) * v.x + lit(m[2][1]) * v.y + lit(m[2][2]) * v.z};
}

BN_INLINE real clamp01(real x)
{
    return clamp(x, lit(0.0), lit(1.0));
}

// Returns the base-2 logarithm of x >= 2^-126. x = 2^n m with m in [sqrt(1/2), sqrt(2)], and log2 m = 2/ln2
// artanh((m-1)/(m+1)) by its series, cut off below 1e-8 relative.
BN_INLINE real log2_of(real x)
{
    const integer n = shr(bits_of(x) - int_lit(0x3f3504f3), 23); // bits of sqrt(1/2)
    const real m = real_from_bits(bits_of(x) - shl(n, 23));
    const real s = (m - lit(1.0)) / (m + lit(1.0));
    const real s2 = s * s;
    real p = lit(1.0 / 9.0);
    p = p * s2 + lit(1.0 / 7.0);
    p = p * s2 + lit(1.0 / 5.0);
    p = p * s2 + lit(1.0 / 3.0);
    p = p * s2 + lit(1.0);
    return to_real(n) + lit(2.8853900817779268) * s * p;
}

// Returns 2^x for x in [-126, 127] by the series of e^(f ln 2), |f| <= 1/2, cut off below 1e-8 relative.
BN_INLINE real exp2_of(real x)
{
    const real bounded = clamp(x, lit(-126.0), lit(127.0));
    const integer n = round_to_int(bounded);
    const real t = (bounded - to_real(n)) * lit(0.69314718055994531);
    real p = lit(1.0 / 5040.0);
    p = p * t + lit(1.0 / 720.0);
    p = p * t + lit(1.0 / 120.0);
    p = p * t + lit(1.0 / 24.0);
    p = p * t + lit(1.0 / 6.0);
    p = p * t + lit(0.5);
    p = p * t + lit(1.0);
    p = p * t + lit(1.0);
    return p * real_from_bits(shl(n + int_lit(127), 23));
}

// Returns x^y for y >= 0. 0 stays 0, so that equal colours have no error.
BN_INLINE real pow_of(real x, real y)
{
    const real power = exp2_of(y * log2_of(max(x, lit(1.2e-38))));
    return select(x > lit(0.0), power, lit(0.0));
}

// Returns the cube root for x in [0.001, 10]. A third of the exponent bits gives a start within 4 %; two Halley
// iterations give 1e-5, then 1e-15.
BN_INLINE real cube_root(real x)
{
    real root = real_from_bits(to_int(to_real(bits_of(x)) * lit(1.0 / 3.0)) + int_lit(709921077));
    for (int i = 0; i < 2; ++i) {
        const real cube = root * root * root;
        root = root * ((cube + x + x) / (cube + cube + x));
    }
    return root;
}

// CIE 1976 L*a*b* function of a coordinate relative to the white point.
BN_INLINE real lab_f(real t)
{
    constexpr double kDelta = 6.0 / 29.0;
    const real line = lit(1.0 / (3.0 * kDelta * kDelta)) * t + lit(4.0 / 29.0);
    return select(t > lit(kDelta * kDelta * kDelta), cube_root(max(t, lit(0.008))), line);
}

// Returns L*a*b* of filtered Y, Cx, Cz, clamped to the display's gamut, with Hunt's adjustment: colours look more
// colourful where they are bright.
BN_INLINE Triple perceived(Triple ycxcz)
{
    const real y = (ycxcz.x + lit(16.0)) * lit(1.0 / 116.0);
    const Triple xyz = {y + ycxcz.y * lit(1.0 / 500.0), y, y - ycxcz.z * lit(1.0 / 200.0)};
    const Triple rgb = times(kToRgb, xyz);
    const Triple gamut = times(kToXyz, {clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)});
    const real fx = lab_f(gamut.x), fy = lab_f(gamut.y), fz = lab_f(gamut.z);
    const real lightness = lit(116.0) * fy - lit(16.0);
    const real hunt = lit(0.01) * lightness;
    return {lightness, hunt * (lit(500.0) * (fx - fy)), hunt * (lit(200.0) * (fy - fz))};
}

// Maps the HyAB distance (Abasi, Tehran, Fairchild 2020) to the power qc = 0.7 onto [0,1]. Distances below pc = 0.4 of
// the largest one fill [0, pt = 0.95].
BN_INLINE real colour_error(Triple a, Triple b, float largest)
{
    const real da = a.y - b.y, db = a.z - b.z;
    const real distance = pow_of(abs(a.x - b.x) + sqrt(da * da + db * db), lit(0.7));
    const real knee = lit(0.4) * splat(largest);
    const real low = distance * (lit(0.95) / knee);
    const real high = lit(0.95) + (distance - knee) / (splat(largest) - knee) * lit(1.0 - 0.95);
    return select(distance < knee, low, high);
}

BN_INLINE real expose(real x, const FlipTone& tone)
{
    return clamp(x * splat(tone.scale), lit(-kBrightest), lit(kBrightest));
}

BN_INLINE real curve_of(real x, const float* c)
{
    const real square = x * x;
    return (square * splat(c[0]) + x * splat(c[1]) + splat(c[2])) / (square * splat(c[3]) + x * splat(c[4]) + splat(c[5]));
}

BN_INLINE Triple displayed(Triple rgb, const FlipTone& tone)
{
    if (tone.curve == FlipTone::none)
        return rgb;
    const Triple x = {expose(rgb.x, tone), expose(rgb.y, tone), expose(rgb.z, tone)};
    if (tone.curve == FlipTone::rational)
        return {curve_of(x.x, tone.c), curve_of(x.y, tone.c), curve_of(x.z, tone.c)};
    const real luminance = lit(0.2126) * x.x + lit(0.7152) * x.y + lit(0.0722) * x.z;
    const real factor = lit(1.0) / (lit(1.0) + luminance);
    return {x.x * factor, x.y * factor, x.z * factor};
}

void prepare(const FlipTone& tone, int n, int stride, const float* linear, float* out)
{
    for (int i = 0; i < n; i += kLanes) {
        const float* from = linear + i;
        float* to = out + i;
        const Triple rgb = displayed({load(from), load(from + stride), load(from + 2 * stride)}, tone);
        const Triple xyz = times(kToXyz, {clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)});
        store(to, lit(116.0) * xyz.y - lit(16.0));
        store(to + stride, lit(500.0) * (xyz.x - xyz.y));
        store(to + 2 * stride, lit(200.0) * (xyz.y - xyz.z));
    }
}

BN_INLINE real even_row(const float* at, const float* weights, int radius)
{
    real sum = load(at) * splat(weights[0]);
    for (int k = 1; k <= radius; ++k)
        sum += (load(at - k) + load(at + k)) * splat(weights[k]);
    return sum;
}

void filter(const FlipFilters& f, const float* y, const float* cx, const float* cz, int n, int stride, float* out)
{
    for (int i = 0; i < n; i += kLanes) {
        // Filter luminance and the feature detectors along x
        const real centre = load(y + i);
        real luma = centre * splat(f.y[0]), gauss = centre * splat(f.gauss[0]);
        real edge = lit(0.0), point = centre * splat(f.point[0]);
        for (int k = 1; k <= f.y_radius; ++k) {
            const real before = load(y + i - k), after = load(y + i + k);
            const real both_sides = before + after;
            luma += both_sides * splat(f.y[k]);
            gauss += both_sides * splat(f.gauss[k]);
            point += both_sides * splat(f.point[k]);
            edge += (after - before) * splat(f.edge[k]);
        }
        // Filter both terms of Cz along x
        real wide = load(cz + i) * splat(f.cz[0]), narrow = load(cz + i) * splat(f.cz2[0]);
        for (int k = 1; k <= f.cz_radius; ++k) {
            const real both_sides = load(cz + i - k) + load(cz + i + k);
            wide += both_sides * splat(f.cz[k]);
            narrow += both_sides * splat(f.cz2[k]);
        }
        store(out + kFlipY * stride + i, luma);
        store(out + kFlipCx * stride + i, even_row(cx + i, f.cx, f.cx_radius));
        store(out + kFlipCz * stride + i, wide);
        store(out + kFlipCz2 * stride + i, narrow);
        store(out + kFlipGauss * stride + i, gauss);
        store(out + kFlipEdge * stride + i, edge);
        store(out + kFlipPoint * stride + i, point);
    }
}

// Sliding window for filters along y over a block of rows. Each row is loaded once: k rows above one row is k + 1 above
// the next.
struct Window {
    const float* const* middle;          // the block's first row
    int offset;                          // offset of plane and column
    real up[kFlipRows], down[kFlipRows]; // rows at equal distance above and below each row of the block
};

BN_INLINE void start(Window& w)
{
    for (int j = 0; j < kFlipRows; ++j)
        w.up[j] = w.down[j] = load(w.middle[j] + w.offset);
}

BN_INLINE void widen(Window& w, int k) // from distance k - 1 to k
{
    for (int j = kFlipRows - 1; j > 0; --j)
        w.up[j] = w.up[j - 1];
    for (int j = 0; j < kFlipRows - 1; ++j)
        w.down[j] = w.down[j + 1];
    w.up[0] = load(w.middle[-k] + w.offset);
    w.down[kFlipRows - 1] = load(w.middle[kFlipRows - 1 + k] + w.offset);
}

BN_INLINE void even_column(const float* const* middle, int offset, const float* weights, int radius, real (&sum)[kFlipRows])
{
    Window w = {middle, offset, {}, {}};
    start(w);
    for (int j = 0; j < kFlipRows; ++j)
        sum[j] = w.up[j] * splat(weights[0]);
    for (int k = 1; k <= radius; ++k) {
        widen(w, k);
        for (int j = 0; j < kFlipRows; ++j)
            sum[j] += (w.up[j] + w.down[j]) * splat(weights[k]);
    }
}

struct Seen {
    Triple colour;    // perceived
    real edge, point; // feature strength in Y, whose range is 116
};

BN_INLINE void look(const FlipFilters& f, const float* const* middle, int stride, int offset, Seen (&seen)[kFlipRows])
{
    // Filter the colour along y
    real a[kFlipRows], b[kFlipRows], c[kFlipRows];
    even_column(middle, offset + kFlipY * stride, f.y, f.y_radius, a);
    even_column(middle, offset + kFlipCx * stride, f.cx, f.cx_radius, b);
    even_column(middle, offset + kFlipCz * stride, f.cz, f.cz_radius, c);
    for (int j = 0; j < kFlipRows; ++j)
        seen[j].colour = {a[j], b[j], c[j]};
    even_column(middle, offset + kFlipCz2 * stride, f.cz2, f.cz_radius, c);
    for (int j = 0; j < kFlipRows; ++j)
        seen[j].colour = perceived({seen[j].colour.x, seen[j].colour.y, seen[j].colour.z + c[j]});

    // Differentiate the Gaussian-filtered rows along y
    Window gauss = {middle, offset + kFlipGauss * stride, {}, {}};
    start(gauss);
    for (int j = 0; j < kFlipRows; ++j) {
        a[j] = lit(0.0);
        b[j] = gauss.up[j] * splat(f.point[0]);
    }
    for (int k = 1; k <= f.y_radius; ++k) {
        widen(gauss, k);
        for (int j = 0; j < kFlipRows; ++j) {
            a[j] += (gauss.down[j] - gauss.up[j]) * splat(f.edge[k]);
            b[j] += (gauss.up[j] + gauss.down[j]) * splat(f.point[k]);
        }
    }
    // Combine the derivatives along x and y
    even_column(middle, offset + kFlipEdge * stride, f.gauss, f.y_radius, c);
    for (int j = 0; j < kFlipRows; ++j)
        seen[j].edge = sqrt(c[j] * c[j] + a[j] * a[j]);
    even_column(middle, offset + kFlipPoint * stride, f.gauss, f.y_radius, c);
    for (int j = 0; j < kFlipRows; ++j)
        seen[j].point = sqrt(c[j] * c[j] + b[j] * b[j]);
}

BN_INLINE real flip_of(const Seen& a, const Seen& b, float max_difference)
{
    const real colour = colour_error(a.colour, b.colour, max_difference);
    // sqrt is the exponent qf = 0.5. 1/sqrt(2) scales to [0,1], and 1/116 is the range of Y.
    const real feature = sqrt(max(abs(a.edge - b.edge), abs(a.point - b.point)) * lit(0.70710678118654752 / 116.0));
    return pow_of(colour, max(lit(1.0) - feature, lit(0.0)));
}

void finish(const FlipFilters& f, const float* const* rows, int radius, int stride, int n, bool keep_larger, float* const* error, int count)
{
    for (int i = 0; i < n; i += kLanes) {
        Seen a[kFlipRows], b[kFlipRows];
        look(f, rows + radius, stride, i, a);
        look(f, rows + radius, stride, i + kFlipPlanes * stride, b);
        for (int j = 0; j < kFlipRows && j < count; ++j) {
            real flip = flip_of(a[j], b[j], f.max_difference);
            if (keep_larger)
                flip = max(flip, load_first(error[j] + i, n - i));
            store_first(error[j] + i, flip, n - i);
        }
    }
}

constexpr FlipFns kFns = {prepare, filter, finish};

} // namespace

BN_DEFINE_FNS(FlipFns, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
