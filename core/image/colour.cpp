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
#include "core/image/tonemap_lanes.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {
namespace {

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
        std::int32_t code = 0;
        for (std::uint32_t key = 1; key < kKeys; ++key) {
            const float lowest = std::bit_cast<float>((key + kFirstKey) << tone::kKeyShift);
            while (least_[static_cast<std::size_t>(code) + 1] <= lowest)
                ++code;
            start_[key] = code;
        }
    }
    tone::CodeTable table() const { return {static_cast<std::int32_t>(kFirstKey), start_.data(), least_.data()}; }
    std::uint8_t encode(float x) const
    {
        const float clamped = clamp01(x);
        const std::uint32_t key = std::bit_cast<std::uint32_t>(clamped) >> tone::kKeyShift;
        std::size_t code = key < kFirstKey ? 0 : static_cast<std::size_t>(start_[key - kFirstKey]);
        while (clamped >= least_[code + 1])
            ++code;
        return static_cast<std::uint8_t>(code);
    }

  private:
    // The first key lies below 2^-13, and so below the first boundary, 1/6588. Keys reach up to 1.
    static constexpr std::uint32_t kFirstKey = (0x39000000u >> tone::kKeyShift) - 1;
    static constexpr std::uint32_t kKeys = (0x3F800000u >> tone::kKeyShift) - kFirstKey + 1;
    std::array<float, 257> least_;
    std::array<std::int32_t, kKeys> start_{};
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

tone::Curve curve_of(Tonemap tonemap)
{
    return tonemap == Tonemap::pbr_neutral ? tone::Curve::pbr_neutral : tonemap == Tonemap::aces ? tone::Curve::aces : tone::Curve::none;
}

// Colours in planes, for lane code.
class Colours {
  public:
    explicit Colours(std::size_t count) : stride_(count + tone::kSlots), planes_(3 * stride_) {}
    float& at(std::size_t channel, std::size_t i) { return planes_[channel * stride_ + i]; }
    // Exposes the first `count` colours, and tone maps them. clips: to [0,1].
    void map(Tonemap tonemap, float scale, std::size_t count, bool clips = true)
    {
        float* const r = planes_.data();
        pick<tone::Fns>().colours({curve_of(tonemap), scale, clips, count, r, r + stride_, r + 2 * stride_});
    }

  private:
    std::size_t stride_;
    std::vector<float> planes_;
};

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

// Runs body(begin, end) over ranges of `count`, on all threads where there are jobs. A range's scratch memory is small.
template <class Body> void for_ranges(std::size_t count, const Jobs* jobs, const Body& body)
{
    constexpr std::size_t kRange = std::size_t{1} << 15;
    const std::size_t ranges = (count + kRange - 1) / kRange;
    const auto run = [&](std::size_t i, int) { body(i * kRange, std::min(count, (i + 1) * kRange)); };
    if (jobs && ranges > 1)
        return jobs->parallel_for_whole(ranges, run);
    for (std::size_t i = 0; i < ranges; ++i)
        run(i, 0);
}

} // namespace

Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const Jobs* jobs)
{
    BN_CHECK(linear.type == PixelType::f32);
    const SrgbTable& table = srgb_table();
    const float scale = exposure_scale(exposure_ev);
    Image out = make_image(linear.width, linear.height, linear.channels, PixelType::u8);
    const std::size_t channels = static_cast<std::size_t>(linear.channels);
    for_ranges(out.bytes.size() / std::max<std::size_t>(channels, 1), jobs, [&](std::size_t begin, std::size_t end) {
        const float* const in = linear.f32() + begin * channels;
        std::uint8_t* const to = reinterpret_cast<std::uint8_t*>(out.bytes.data()) + begin * channels;
        const std::size_t count = end - begin;
        if (channels >= 3) {
            pick<tone::Fns>().pixels({curve_of(tonemap), scale, table.table(), linear.channels, count, in, to});
            return;
        }
        // Tone map grays as colours
        Colours colours(count);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < count; ++i)
                colours.at(c, i) = in[i * channels];
        colours.map(tonemap, scale, count);
        for (std::size_t i = 0; i < count; ++i) {
            to[i * channels] = table.encode(colours.at(0, i));
            if (channels == 2) // coverage is linear
                to[i * channels + 1] = static_cast<std::uint8_t>(clamp01(in[i * channels + 1]) * 255.0f + 0.5f);
        }
    });
    return out;
}

namespace {

// Resolves the pixels of parts [begin, end). to: the picture's codes, `channels` a pixel.
void resolve_parts(const std::vector<PixelPart>& parts, std::size_t begin, std::size_t end, Tonemap tonemap, float scale, bool weighted,
                   std::size_t channels, std::uint8_t* to)
{
    // Divide the colours by alpha, then expose and tone map them. A weighted average is tone mapped afterwards.
    const auto alpha_of = [&](const PixelPart& part) { return channels == 4 ? part.alpha : 1.0f; };
    Colours colours(end - begin);
    for (std::size_t k = begin; k < end; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            colours.at(c, k - begin) = parts[k].color[c] / alpha_of(parts[k]);
    colours.map(weighted ? Tonemap::none : tonemap, scale, end - begin, !weighted);
    // Average each pixel's parts
    std::vector<std::size_t> pixels;
    for (std::size_t k = begin; k < end;) {
        const std::size_t pixel = parts[k].pixel;
        float sum[3] = {}, weights = 0.0f;
        for (; k < end && parts[k].pixel == pixel; ++k) {
            const PixelPart& part = parts[k];
            if (part.background && channels == 4)
                continue;
            const float rgb[3] = {colours.at(0, k - begin), colours.at(1, k - begin), colours.at(2, k - begin)};
            const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
            const float weight = static_cast<float>(part.samples) * alpha_of(part) / (weighted ? 1.0f + luminance : 1.0f);
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += rgb[c] * weight;
            weights += weight;
        }
        if (!(weights > 0.0f))
            continue;
        for (std::size_t c = 0; c < 3; ++c)
            colours.at(c, pixels.size()) = sum[c] / weights; // over a part that has been read
        pixels.push_back(pixel);
    }
    if (weighted)
        colours.map(tonemap, 1.0f, pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            to[channels * pixels[i] + c] = srgb_table().encode(colours.at(c, i));
}

} // namespace

Image tonemap_to_srgb8(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts, Resolve resolve,
                       const Jobs* jobs)
{
    Image out = tonemap_to_srgb8(linear, tonemap, exposure_ev, jobs);
    if (resolve == Resolve::linear || parts.empty())
        return out;
    const float scale = exposure_scale(exposure_ev);
    const std::size_t channels = static_cast<std::size_t>(linear.channels);
    BN_CHECK(channels >= 3);
    const auto goes_on = [&](std::size_t k) { return k > 0 && k < parts.size() && parts[k].pixel == parts[k - 1].pixel; };
    // A range has the pixels whose first part lies in it
    for_ranges(parts.size(), jobs, [&](std::size_t begin, std::size_t end) {
        while (begin < end && goes_on(begin))
            ++begin;
        while (begin < end && goes_on(end))
            ++end;
        resolve_parts(parts, begin, end, tonemap, scale, resolve == Resolve::weighted, channels,
                      reinterpret_cast<std::uint8_t*>(out.bytes.data()));
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
