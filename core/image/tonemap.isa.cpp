#include "core/image/tonemap_lanes.h"
#include "core/simd/lanes.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

constexpr std::size_t kLane = static_cast<std::size_t>(kLanes);
static_assert(kLane <= tone::kSlots);

struct Rgb {
    real r, g, b;
};

// Returns exposed radiance as input for a tone mapper: NaN and negative values become 0, Inf a large finite value.
BN_INLINE real expose(real radiance, real scale)
{
    const real x = radiance * scale, brightest = splat(1e12f); // white in every curve, and the square stays finite
    return select(x > lit(0.0), min(x, brightest), lit(0.0));
}

BN_INLINE real clamp01(real x) // NaN becomes 0
{
    return select(x > lit(0.0), min(x, lit(1.0)), lit(0.0));
}

// Applies the Khronos PBR Neutral tone mapper, specification 1.0 (2024), after its reference GLSL.
BN_INLINE Rgb pbr_neutral(const Rgb& in)
{
    constexpr float kStart = 0.8f - 0.04f, kRoom = 1.0f - kStart; // compression begins at kStart
    const real one = lit(1.0), desaturation = splat(0.15f);
    const real low = min(in.r, min(in.g, in.b));
    const real offset = select(low < splat(0.08f), low - splat(6.25f) * low * low, splat(0.04f));
    const Rgb c = {in.r - offset, in.g - offset, in.b - offset};
    const real peak = max(c.r, max(c.g, c.b));
    const mask kept = peak < splat(kStart);
    const real new_peak = one - splat(kRoom * kRoom) / (peak + splat(kRoom) - splat(kStart));
    const real scale = new_peak / peak;
    const real to_white = one - one / (desaturation * (peak - new_peak) + one);
    const auto mix = [&](real x) { return select(kept, x, x * scale * (one - to_white) + new_peak * to_white); };
    return {mix(c.r), mix(c.g), mix(c.b)};
}

BN_INLINE Rgb multiply(const float (&m)[3][3], const Rgb& c)
{
    const auto row = [&](int i) { return splat(m[i][0]) * c.r + splat(m[i][1]) * c.g + splat(m[i][2]) * c.b; };
    return {row(0), row(1), row(2)};
}

// Applies Stephen Hill's fit of the ACES RRT and sRGB ODT (published with MJP's BakingLab, ACES.hlsl, 2016). As in that
// source, there is no extra exposure factor.
BN_INLINE Rgb aces_hill(const Rgb& c)
{
    static constexpr float kIn[3][3] = {{0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
    static constexpr float kOut[3][3] = {
        {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
    const auto fit = [](real v) {
        const real a = v * (v + splat(0.0245786f)) - splat(0.000090537f);
        const real b = v * (splat(0.983729f) * v + splat(0.4329510f)) + splat(0.238081f);
        return a / b;
    };
    const Rgb in = multiply(kIn, c);
    return multiply(kOut, {fit(in.r), fit(in.g), fit(in.b)});
}

BN_INLINE Rgb mapped(tone::Curve curve, real scale, const Rgb& radiance)
{
    const Rgb c = {expose(radiance.r, scale), expose(radiance.g, scale), expose(radiance.b, scale)};
    return curve == tone::Curve::pbr_neutral ? pbr_neutral(c) : curve == tone::Curve::aces ? aces_hill(c) : c;
}

BN_INLINE integer encode(const tone::CodeTable& table, real x)
{
    const real clamped = clamp01(x);
    const integer key = max(shr(bits_of(clamped), tone::kKeyShift) - int_lit(table.first_key), int_lit(0));
    integer code = gather_int(table.start, key);
    for (mask more = clamped >= gather(table.least + 1, code); any(more); more = clamped >= gather(table.least + 1, code))
        code = select(more, code + int_lit(1), code);
    return code;
}

void pixels(const tone::PixelWork& w)
{
    const real scale = splat(w.scale);
    const std::size_t channels = static_cast<std::size_t>(w.channels);
    alignas(64) std::int32_t words[4 * kLanes] = {};
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const std::size_t some = w.count - at < kLane ? w.count - at : kLane;
        __builtin_memcpy(words, w.from + channels * at, 4 * channels * some);
        integer v[4];
        if (channels == 3)
            load_triples_int(words, v);
        else
            load_quads(words, iota(), v);
        const Rgb c = mapped(w.curve, scale, {real_from_bits(v[0]), real_from_bits(v[1]), real_from_bits(v[2])});
        integer codes = encode(w.table, c.r) | shl(encode(w.table, c.g), 8) | shl(encode(w.table, c.b), 16);
        if (channels == 4)
            codes = codes | shl(to_int(clamp01(real_from_bits(v[3])) * lit(255.0) + lit(0.5)), 24);
        store_int(words, codes);
        std::uint8_t* to = w.to + channels * at;
        if (channels == 4) {
            __builtin_memcpy(to, words, 4 * some);
            continue;
        }
        for (std::size_t i = 0; i + 1 < some; ++i, to += 3)
            __builtin_memcpy(to, words + i, 4); // the fourth byte belongs to the next pixel, which follows
        __builtin_memcpy(to, words + some - 1, 3);
    }
}

void colours(const tone::ColourWork& w)
{
    const real scale = splat(w.scale);
    for (std::size_t at = 0; at < w.count; at += kLane) {
        const Rgb c = mapped(w.curve, scale, {load(w.r + at), load(w.g + at), load(w.b + at)});
        const auto kept = [&](real x) { return w.clips ? clamp01(x) : x; };
        store(w.r + at, kept(c.r)), store(w.g + at, kept(c.g)), store(w.b + at, kept(c.b));
    }
}

constexpr tone::Fns kToneFns = {pixels, colours};

} // namespace

BN_DEFINE_FNS(tone::Fns, kToneFns)

} // namespace BN_ISA_NS
} // namespace burnish
