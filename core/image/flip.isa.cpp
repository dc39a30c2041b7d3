// FLIP's pixels, after Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images", sections 4.1 to 4.3, with the filters separated as in the
// authors' note "Separated convolutions" (2021).
#include "core/image/flip_lanes.h"
#include "core/simd/lanes.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

struct Triple {
    real x, y, z;
};

// Linear Rec.709 to XYZ relative to the white point, whose X and Z (Y = 1) are FLIP's values of D65.
constexpr double kWhiteX = 0.950428545, kWhiteZ = 1.088900371;
constexpr double kToXyz[3][3] = {
    {10135552.0 / 24577794.0 / kWhiteX, 8788810.0 / 24577794.0 / kWhiteX, 4435075.0 / 24577794.0 / kWhiteX},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0 / kWhiteZ, 8788810.0 / 73733382.0 / kWhiteZ, 70074185.0 / 73733382.0 / kWhiteZ}};
constexpr double kToRgb[3][3] = {{3.241003275 * kWhiteX, -1.537398934, -0.498615861 * kWhiteZ},
                                 {-0.969224334 * kWhiteX, 1.875930071, 0.041554224 * kWhiteZ},
                                 {0.055639423 * kWhiteX, -0.204011202, 1.057148933 * kWhiteZ}};
// Larger radiance counts as this, so that its square is finite; every tone curve is flat there.
constexpr double kBrightest = 1e15;

BN_INLINE Triple times(const double (&m)[3][3], Triple v)
{
    return {lit(m[0][0]) * v.x + lit(m[0][1]) * v.y + lit(m[0][2]) * v.z,
            lit(m[1][0]) * v.x + lit(m[1][1]) * v.y + lit(m[1][2]) * v.z,
            lit(m[2][0]) * v.x + lit(m[2][1]) * v.y + lit(m[2][2]) * v.z};
}

BN_INLINE real clamp01(real x)
{
    return clamp(x, lit(0.0), lit(1.0));
}

// Base-2 logarithm of x >= 2^-126: x = 2^n m with m in [sqrt(1/2), sqrt(2)], log2 m = 2/ln2
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

// 2^x for x in [-126, 127]: the series of e^(f ln 2), |f| <= 1/2, cut off below 1e-8 relative.
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

// x^y for y >= 0. 0 stays 0, so that what is equal has no error.
BN_INLINE real pow_of(real x, real y)
{
    const real power = exp2_of(y * log2_of(max(x, lit(1.2e-38))));
    return select(x > lit(0.0), power, lit(0.0));
}

// For x in [0.001, 10]: a third of the exponent bits, 4 % off, then Halley's iteration twice, 1e-5 and 1e-15
// off.
BN_INLINE real cube_root(real x)
{
    real root = real_from_bits(to_int(to_real(bits_of(x)) * lit(1.0 / 3.0)) + int_lit(709921077));
    for (int i = 0; i < 2; ++i) {
        const real cube = root * root * root;
        root = root * ((cube + x + x) / (cube + cube + x));
    }
    return root;
}

// CIE 1976 L*a*b* of XYZ relative to the white point.
BN_INLINE real lab_f(real t)
{
    constexpr double kDelta = 6.0 / 29.0;
    const real line = lit(1.0 / (3.0 * kDelta * kDelta)) * t + lit(4.0 / 29.0);
    return select(t > lit(kDelta * kDelta * kDelta), cube_root(max(t, lit(0.008))), line);
}

// L*a*b* of filtered Y, Cx, Cz, clamped to the display's gamut, with Hunt's adjustment: colours look more
// colourful where it is bright.
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

// HyAB distance (Abasi, Tehran, Fairchild 2020) to the power qc = 0.7, spread over [0,1]: what lies below
// pc = 0.4 of the largest fills [0, pt = 0.95].
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
    return (square * splat(c[0]) + x * splat(c[1]) + splat(c[2])) /
           (square * splat(c[3]) + x * splat(c[4]) + splat(c[5]));
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

void prepare(const FlipTone& tone, int n, float* r, float* g, float* b)
{
    for (int i = 0; i < n; i += kLanes) {
        const Triple rgb = displayed({load(r + i), load(g + i), load(b + i)}, tone);
        const Triple xyz = times(kToXyz, {clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)});
        store(r + i, lit(116.0) * xyz.y - lit(16.0));
        store(g + i, lit(500.0) * (xyz.x - xyz.y));
        store(b + i, lit(200.0) * (xyz.y - xyz.z));
    }
}

BN_INLINE real even_row(const float* at, const float* weights, int radius)
{
    real sum = load(at) * splat(weights[0]);
    for (int k = 1; k <= radius; ++k)
        sum += (load(at - k) + load(at + k)) * splat(weights[k]);
    return sum;
}

void filter(const FlipFilters& f, const float* y, const float* cx, const float* cz, int n, int stride,
            float* out)
{
    for (int i = 0; i < n; i += kLanes) {
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

BN_INLINE real even_column(const float* const* middle, int offset, const float* weights, int radius)
{
    real sum = load(middle[0] + offset) * splat(weights[0]);
    for (int k = 1; k <= radius; ++k)
        sum += (load(middle[-k] + offset) + load(middle[k] + offset)) * splat(weights[k]);
    return sum;
}

struct Seen {
    Triple colour;    // perceived
    real edge, point; // strength of features in Y, whose range is 116
};

BN_INLINE Seen look(const FlipFilters& f, const float* const* middle, int stride, int offset)
{
    const int at_y = offset + kFlipY * stride, at_gauss = offset + kFlipGauss * stride;
    const int at_edge = offset + kFlipEdge * stride, at_point = offset + kFlipPoint * stride;
    real luma = load(middle[0] + at_y) * splat(f.y[0]);
    real edge_x = load(middle[0] + at_edge) * splat(f.gauss[0]), edge_y = lit(0.0);
    real point_x = load(middle[0] + at_point) * splat(f.gauss[0]);
    real point_y = load(middle[0] + at_gauss) * splat(f.point[0]);
    for (int k = 1; k <= f.y_radius; ++k) {
        const float *above = middle[-k], *below = middle[k];
        const real g = splat(f.gauss[k]);
        luma += (load(above + at_y) + load(below + at_y)) * splat(f.y[k]);
        edge_x += (load(above + at_edge) + load(below + at_edge)) * g;
        point_x += (load(above + at_point) + load(below + at_point)) * g;
        const real gauss_above = load(above + at_gauss), gauss_below = load(below + at_gauss);
        edge_y += (gauss_below - gauss_above) * splat(f.edge[k]);
        point_y += (gauss_above + gauss_below) * splat(f.point[k]);
    }
    const real cx = even_column(middle, offset + kFlipCx * stride, f.cx, f.cx_radius);
    const real cz = even_column(middle, offset + kFlipCz * stride, f.cz, f.cz_radius) +
                    even_column(middle, offset + kFlipCz2 * stride, f.cz2, f.cz_radius);
    return {perceived({luma, cx, cz}), sqrt(edge_x * edge_x + edge_y * edge_y),
            sqrt(point_x * point_x + point_y * point_y)};
}

void finish(const FlipFilters& f, const float* const* rows, int radius, int stride, int n, bool keep_larger,
            float* error)
{
    for (int i = 0; i < n; i += kLanes) {
        const Seen a = look(f, rows + radius, stride, i);
        const Seen b = look(f, rows + radius, stride, i + kFlipPlanes * stride);
        const real colour = colour_error(a.colour, b.colour, f.max_difference);
        // sqrt: the exponent qf = 0.5. 1/sqrt(2) scales to [0,1], 1/116 is the range of Y.
        const real feature =
            sqrt(max(abs(a.edge - b.edge), abs(a.point - b.point)) * lit(0.70710678118654752 / 116.0));
        real flip = pow_of(colour, max(lit(1.0) - feature, lit(0.0)));
        if (keep_larger)
            flip = max(flip, load_first(error + i, n - i));
        store_first(error + i, flip, n - i);
    }
}

constexpr FlipFns kFns = {prepare, filter, finish};

} // namespace

const FlipFns& flip_lanes()
{
    return kFns;
}

} // namespace BN_ISA_NS
} // namespace burnish
