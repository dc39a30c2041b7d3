// Colour arithmetic with + - * / and square roots in double only. No libm function, because the last digits differ
// between machines.
#include "core/image/colour.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/check.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

// Upper bound of radiance before tonemapping. Larger values are white in every operator; the square stays finite.
constexpr float kBrightest = 1e12f;

// Returns t^(1/5) for t in [0.001, 1]. Newton's iteration from above converges monotonically to the last digits.
double fifth_root(double t)
{
    double y = 1.0;
    for (int i = 0; i < 16; ++i)
        y = (4.0 * y + t / (y * y * y * y)) * 0.2;
    return y;
}

double cube_root(double t) // like fifth_root
{
    double y = 1.0;
    for (int i = 0; i < 16; ++i)
        y = (2.0 * y + t / (y * y)) / 3.0;
    return y;
}

// Decodes sRGB by IEC 61966-2-1:1999 section 5.2, eq. 5 and 6, for x in [0,1].
double decode_srgb(double x)
{
    if (x <= 0.04045)
        return x / 12.92;
    const double t = (x + 0.055) / 1.055;
    const double root = fifth_root(t);
    return t * t * root * root; // t^2.4
}

double encode_srgb(double x)
{
    if (x <= 0.0031308)
        return 12.92 * x;
    const double twelfth = std::sqrt(std::sqrt(cube_root(x)));
    const double square = twelfth * twelfth;
    return 1.055 * (square * square * twelfth) - 0.055; // x^(1/2.4) = x^(5/12)
}

float clamp01(float x)
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; // NaN becomes 0
}

// Encodes 8-bit sRGB: compares a value with the 255 boundaries between codes, so that every code is correctly rounded.
// A table over the float's upper bits gives the first candidate.
class SrgbTable {
  public:
    SrgbTable()
    {
        for (std::size_t code = 1; code < 256; ++code) {
            // Find the smallest float at or above the boundary.
            const double boundary = decode_srgb((static_cast<double>(code) - 0.5) / 255.0);
            const float rounded = static_cast<float>(boundary);
            const bool below = static_cast<double>(rounded) < boundary;
            least_[code] = below ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(rounded) + 1) : rounded;
        }
        least_[0] = 0.0f;
        least_[256] = 2.0f; // never reached
        std::size_t code = 0;
        for (std::uint32_t key = 0; key < kKeys; ++key) {
            const float lowest = std::bit_cast<float>((key + kFirstKey) << kShift);
            while (least_[code + 1] <= lowest)
                ++code;
            start_[key] = static_cast<std::uint8_t>(code);
        }
    }
    std::uint8_t encode(float x) const
    {
        const float clamped = clamp01(x);
        const std::uint32_t key = std::bit_cast<std::uint32_t>(clamped) >> kShift;
        std::size_t code = key < kFirstKey ? 0 : start_[key - kFirstKey];
        while (clamped >= least_[code + 1])
            ++code;
        return static_cast<std::uint8_t>(code);
    }

  private:
    static constexpr std::uint32_t kShift = 16;                                     // 128 keys an octave
    static constexpr std::uint32_t kFirstKey = 0x39000000u >> kShift;               // 2^-13, below the first boundary, 1/6588
    static constexpr std::uint32_t kKeys = (0x3F800000u >> kShift) - kFirstKey + 1; // up to 1.0
    std::array<float, 257> least_;
    std::array<std::uint8_t, kKeys> start_;
};

// Returns 2^ev by the Taylor series of e^(f ln 2), f in [-0.5, 0.5]: 18 terms reach double precision.
float exposure_scale(float ev)
{
    BN_CHECK(ev >= -126.0f && ev <= 126.0f);
    const int whole = static_cast<int>(ev < 0.0f ? ev - 0.5f : ev + 0.5f);
    const double x = (static_cast<double>(ev) - whole) * 0.69314718055994530942;
    double term = 1.0, sum = 1.0;
    for (int i = 1; i <= 18; ++i) {
        term = term * x / i;
        sum += term;
    }
    return static_cast<float>(std::ldexp(sum, whole)); // ldexp is exact
}

struct Rgb {
    float r, g, b;
};

// Applies the Khronos PBR Neutral tone mapper, specification 1.0 (2024), after its reference GLSL.
Rgb pbr_neutral(Rgb c)
{
    constexpr float kStart = 0.8f - 0.04f; // compression begins here
    constexpr float kDesaturation = 0.15f;
    const float low = std::min(c.r, std::min(c.g, c.b));
    const float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    c = {c.r - offset, c.g - offset, c.b - offset};
    const float peak = std::max(c.r, std::max(c.g, c.b));
    if (peak < kStart)
        return c;
    constexpr float kRoom = 1.0f - kStart;
    const float new_peak = 1.0f - kRoom * kRoom / (peak + kRoom - kStart);
    const float scale = new_peak / peak;
    const float to_white = 1.0f - 1.0f / (kDesaturation * (peak - new_peak) + 1.0f);
    const auto mix = [&](float x) { return x * scale * (1.0f - to_white) + new_peak * to_white; };
    return {mix(c.r), mix(c.g), mix(c.b)};
}

Rgb multiply(const float (&m)[3][3], Rgb c)
{
    return {m[0][0] * c.r + m[0][1] * c.g + m[0][2] * c.b, m[1][0] * c.r + m[1][1] * c.g + m[1][2] * c.b,
            m[2][0] * c.r + m[2][1] * c.g + m[2][2] * c.b};
}

// Applies Stephen Hill's fit of the ACES RRT and sRGB ODT (published with MJP's BakingLab, ACES.hlsl, 2016). As in that
// source, there is no extra exposure factor.
Rgb aces_hill(Rgb c)
{
    static constexpr float kIn[3][3] = {{0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
    static constexpr float kOut[3][3] = {
        {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
    const auto fit = [](float v) {
        const float a = v * (v + 0.0245786f) - 0.000090537f;
        const float b = v * (0.983729f * v + 0.4329510f) + 0.238081f;
        return a / b;
    };
    const Rgb in = multiply(kIn, c);
    return multiply(kOut, {fit(in.r), fit(in.g), fit(in.b)});
}

Rgb apply(Tonemap tonemap, Rgb c)
{
    switch (tonemap) {
    case Tonemap::pbr_neutral:
        return pbr_neutral(c);
    case Tonemap::aces:
        return aces_hill(c);
    case Tonemap::none:
        break;
    }
    return c;
}

// Returns exposed radiance as input for a tone mapper: NaN and negative values become 0, Inf a large finite value.
float expose(float radiance, float scale)
{
    const float x = radiance * scale;
    return x > 0.0f ? std::min(x, kBrightest) : 0.0f;
}

const SrgbTable& srgb_table()
{
    static const SrgbTable table;
    return table;
}

} // namespace

Result<Tonemap> parse_tonemap(const std::string& name)
{
    if (name == "none")
        return Tonemap::none;
    if (name == "pbr-neutral")
        return Tonemap::pbr_neutral;
    if (name == "aces")
        return Tonemap::aces;
    return Error{ExitCode::usage, "", "", "unknown tonemap \"" + name + "\" (none, pbr-neutral, aces)"};
}

namespace {

// Runs body(begin, end) over ranges of `count`, on all threads where there are jobs.
template <class Body> void for_ranges(std::size_t count, const Jobs* jobs, const Body& body)
{
    constexpr std::size_t kRange = std::size_t{1} << 15;
    const std::size_t ranges = (count + kRange - 1) / kRange;
    if (!jobs || ranges < 2)
        return body(std::size_t{0}, count);
    jobs->parallel_for_whole(ranges, [&](std::size_t i, int) { body(i * kRange, std::min(count, (i + 1) * kRange)); });
}

} // namespace

Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const Jobs* jobs)
{
    BN_CHECK(linear.type == PixelType::f32);
    const SrgbTable& table = srgb_table();
    const float scale = exposure_scale(exposure_ev);
    Image out = make_image(linear.width, linear.height, linear.channels, PixelType::u8);
    const std::size_t channels = static_cast<std::size_t>(linear.channels);
    const bool colour = channels >= 3, alpha = channels % 2 == 0;
    const float* const in = linear.f32();
    std::uint8_t* const to = reinterpret_cast<std::uint8_t*>(out.bytes.data());
    for_ranges(out.bytes.size() / std::max<std::size_t>(channels, 1), jobs, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * channels; i < end * channels; i += channels) {
            const float r = expose(in[i], scale);
            const Rgb exposed = colour ? Rgb{r, expose(in[i + 1], scale), expose(in[i + 2], scale)} : Rgb{r, r, r};
            const Rgb mapped = apply(tonemap, exposed);
            to[i] = table.encode(mapped.r);
            if (colour) {
                to[i + 1] = table.encode(mapped.g);
                to[i + 2] = table.encode(mapped.b);
            }
            if (alpha) // coverage is linear
                to[i + channels - 1] = static_cast<std::uint8_t>(clamp01(in[i + channels - 1]) * 255.0f + 0.5f);
        }
    });
    return out;
}

namespace {

Rgb clipped(const Rgb& c)
{
    return {clamp01(c.r), clamp01(c.g), clamp01(c.b)};
}

float luminance_of(const Rgb& c)
{
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

} // namespace

Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts, Resolve resolve,
                       const Jobs* jobs)
{
    Image out = tonemap_to_srgb8(linear, tonemap, exposure_ev, jobs);
    if (resolve == Resolve::linear)
        return out;
    const float scale = exposure_scale(exposure_ev);
    const std::size_t channels = static_cast<std::size_t>(linear.channels);
    BN_CHECK(parts.empty() || channels >= 3);
    const auto resolve_pixel = [&](std::size_t first, std::size_t end) {
        // Average the pixel's parts
        float sum[3] = {}, weights = 0.0f;
        for (std::size_t k = first; k < end; ++k) {
            const PixelPart& part = parts[k];
            if (part.background && channels == 4)
                continue;
            // Divide the colour by alpha, and weigh it by alpha
            const float alpha = channels == 4 ? part.alpha : 1.0f;
            const auto whole = [&](std::size_t c) { return expose(part.color[c] / alpha, scale); };
            const Rgb exposed = {whole(0), whole(1), whole(2)};
            const bool weighted = resolve == Resolve::weighted;
            const float weight = static_cast<float>(part.samples) * alpha / (weighted ? 1.0f + luminance_of(exposed) : 1.0f);
            const Rgb kept = weighted ? exposed : clipped(apply(tonemap, exposed));
            sum[0] += kept.r * weight, sum[1] += kept.g * weight, sum[2] += kept.b * weight;
            weights += weight;
        }
        // Tonemap a weighted average after resolving
        if (weights > 0.0f && resolve == Resolve::weighted) {
            const Rgb mapped = clipped(apply(tonemap, {sum[0] / weights, sum[1] / weights, sum[2] / weights}));
            sum[0] = mapped.r, sum[1] = mapped.g, sum[2] = mapped.b, weights = 1.0f;
        }
        std::uint8_t* const to = reinterpret_cast<std::uint8_t*>(out.bytes.data()) + channels * parts[first].pixel;
        for (std::size_t c = 0; weights > 0.0f && c < 3; ++c)
            to[c] = srgb_table().encode(sum[c] / weights);
    };
    // A range has the pixels whose first part lies in it
    for_ranges(parts.size(), jobs, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end;) {
            std::size_t next = first + 1;
            while (next < parts.size() && parts[next].pixel == parts[first].pixel)
                ++next;
            if (first == 0 || parts[first - 1].pixel != parts[first].pixel)
                resolve_pixel(first, next);
            first = next;
        }
    });
    return out;
}

Image unassociated(const Image& image)
{
    BN_CHECK(image.type == PixelType::f32 && image.channels == 4);
    Image out = image;
    float* v = out.f32();
    for (std::size_t i = 0; i < out.bytes.size() / sizeof(float); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            v[i + c] = v[i + 3] > 0.0f ? v[i + c] / v[i + 3] : 0.0f;
    return out;
}

float srgb_to_linear(float encoded)
{
    return static_cast<float>(decode_srgb(static_cast<double>(clamp01(encoded))));
}

float linear_to_srgb(float linear)
{
    return static_cast<float>(encode_srgb(static_cast<double>(clamp01(linear))));
}

} // namespace burnish
