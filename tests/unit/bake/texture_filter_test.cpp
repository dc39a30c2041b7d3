#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "shading/bake/mip/texture.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

const double kNan = std::nan(""), kInf = HUGE_VAL;

Image noise(int width, int height)
{
    Image image = make_image(width, height, 4, PixelType::u8);
    Random random(7);
    for (std::byte& b : image.bytes)
        b = static_cast<std::byte>(random() * 256.0);
    return image;
}

TexturePyramid noise_pyramid(int width, int height, WrapMode s, WrapMode t, bool nearest = false)
{
    Texture sampler;
    sampler.wrap_s = s, sampler.wrap_t = t, sampler.nearest = nearest;
    return make_texture_pyramid(noise(width, height), sampler, TextureEncoding::linear);
}

TexelView view_of(const TexturePyramid& p, int max_taps = 16)
{
    return {.texels = p.texels.data(),
            .levels = p.levels,
            .offset = p.offset,
            .level_width = p.level_width,
            .level_height = p.level_height,
            .wrap_s = static_cast<int>(p.wrap_s),
            .wrap_t = static_cast<int>(p.wrap_t),
            .nearest = p.nearest,
            .max_taps = max_taps};
}

// ---- naive reference: textbook formulas on the inner texels, in double ----

int wrap_index(WrapMode mode, long i, int n)
{
    const auto mod = [](long a, long b) { return ((a % b) + b) % b; };
    if (mode == WrapMode::repeat)
        return static_cast<int>(mod(i, n));
    if (mode == WrapMode::clamp)
        return static_cast<int>(std::clamp(i, 0L, static_cast<long>(n) - 1));
    const long m = mod(i, 2L * n);
    return static_cast<int>(m < n ? m : 2L * n - 1 - m);
}

double naive_texel(const TexturePyramid& p, int level, long x, long y, int c)
{
    const int w = static_cast<int>(p.level_width[level]), h = static_cast<int>(p.level_height[level]);
    const int ix = wrap_index(p.wrap_s, x, w), iy = wrap_index(p.wrap_t, y, h);
    const int at = p.offset[level] + (iy + 1) * (w + 2) + ix + 1;
    return static_cast<double>(half_to_float(p.texels[static_cast<std::size_t>(4 * at + c)]));
}

double naive_bilinear(const TexturePyramid& p, int level, double u, double v, int c)
{
    const double x = u * static_cast<double>(p.level_width[level]) - 0.5, y = v * static_cast<double>(p.level_height[level]) - 0.5;
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const long ix = static_cast<long>(std::floor(x)), iy = static_cast<long>(std::floor(y));
    return (naive_texel(p, level, ix, iy, c) * (1 - fx) + naive_texel(p, level, ix + 1, iy, c) * fx) * (1 - fy) +
           (naive_texel(p, level, ix, iy + 1, c) * (1 - fx) + naive_texel(p, level, ix + 1, iy + 1, c) * fx) * fy;
}

struct NaiveFootprint {
    double lod, taps, axis_u, axis_v;
};
NaiveFootprint naive_footprint(const TexturePyramid& p, const double d[4], int max_taps)
{
    const double px = std::hypot(d[0] * p.width, d[1] * p.height), py = std::hypot(d[2] * p.width, d[3] * p.height);
    const double longer = std::max(px, py), shorter = std::min(px, py);
    const double e = std::min(longer == 0.0 ? 1.0 : longer / std::max(shorter, 1e-9), static_cast<double>(max_taps));
    NaiveFootprint f;
    f.taps = std::ceil(std::min(e, std::max(longer, 1.0)) - 1.0 / 256);
    f.lod = std::clamp(std::log2(std::max(longer / e, 1e-30)), 0.0, p.levels - 1.0);
    f.axis_u = px >= py ? d[0] : d[2];
    f.axis_v = px >= py ? d[1] : d[3];
    return f;
}

double naive_sample(const TexturePyramid& p, double u, double v, const NaiveFootprint& f, int c)
{
    const int level = static_cast<int>(f.lod), next = std::min(level + 1, p.levels - 1);
    double sum = 0.0;
    for (int i = 1; i <= static_cast<int>(f.taps); ++i) {
        const double along = i / (f.taps + 1.0) - 0.5;
        const double tu = u + f.axis_u * along, tv = v + f.axis_v * along, fraction = f.lod - level;
        sum += naive_bilinear(p, level, tu, tv, c) * (1 - fraction) + naive_bilinear(p, next, tu, tv, c) * fraction;
    }
    return sum / f.taps;
}

// ---- the compared samples ----

constexpr int kSamples = 1024;

// Returns u, v and the four derivatives, kSamples of each. Axis lengths range from far below to far above a texel, with every ratio.
std::vector<float> sample_positions(const TexturePyramid& p)
{
    std::vector<float> uv(6 * kSamples);
    Random random(42);
    for (std::size_t i = 0; i < kSamples; ++i) {
        uv[i] = random.in(-2.5, 2.5);
        uv[kSamples + i] = random.in(-2.5, 2.5);
        const double angle = random() * 6.2831853, longer = std::exp2(random() * 9.0 - 3.0), ratio = std::exp2(-6.0 * random());
        const bool swap = random() < 0.5;
        const double a[2] = {std::cos(angle) * longer / p.width, std::sin(angle) * longer / p.height};
        const double b[2] = {-std::sin(angle) * longer * ratio / p.width, std::cos(angle) * longer * ratio / p.height};
        for (std::size_t c = 0; c < 2; ++c) {
            uv[(2 + c) * kSamples + i] = static_cast<float>(swap ? b[c] : a[c]);
            uv[(4 + c) * kSamples + i] = static_cast<float>(swap ? a[c] : b[c]);
        }
    }
    return uv;
}

NaiveFootprint naive_footprint_at(const TexturePyramid& p, const std::vector<float>& uv, std::size_t i, int max_taps)
{
    double d[4];
    for (std::size_t c = 0; c < 4; ++c)
        d[c] = static_cast<double>(uv[(2 + c) * kSamples + i]);
    return naive_footprint(p, d, max_taps);
}

void expect_equals_naive(const TexturePyramid& p, int max_taps)
{
    const std::vector<float> uv = sample_positions(p), rgba = results(float_fns()[0], "texture_exact", uv, view_of(p, max_taps)),
                             exact = results(oracle_fns(), "texture_exact", uv, view_of(p, max_taps));
    for (std::size_t i = 0; i < kSamples; ++i) {
        const NaiveFootprint f = naive_footprint_at(p, uv, i, max_taps);
        for (std::size_t c = 0; c < 4; ++c) {
            const double naive = naive_sample(p, static_cast<double>(uv[i]), static_cast<double>(uv[kSamples + i]), f, static_cast<int>(c));
            ASSERT_NEAR(static_cast<double>(rgba[4 * i + c]), naive, 2e-4) << "sample " << i << " taps " << f.taps << " lod " << f.lod;
            ASSERT_NEAR(static_cast<double>(exact[4 * i + c]), naive, 1e-6) << "sample " << i << " taps " << f.taps << " lod " << f.lod;
        }
    }
}

TEST(texture_filter, trilinear_equals_the_naive_reference_in_every_wrap_mode)
{
    const WrapMode modes[] = {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror};
    for (const WrapMode s : modes)
        for (const WrapMode t : modes)
            expect_equals_naive(noise_pyramid(37, 20, s, t), 1);
}

TEST(texture_filter, anisotropic_equals_the_naive_reference)
{
    expect_equals_naive(noise_pyramid(64, 64, WrapMode::repeat, WrapMode::repeat), 16);
    expect_equals_naive(noise_pyramid(50, 21, WrapMode::mirror, WrapMode::clamp), 7);
}

TEST(texture_filter, tap_counts_follow_the_footprint)
{
    const TexturePyramid p = noise_pyramid(64, 64, WrapMode::repeat, WrapMode::repeat);
    const float n = 1.0f / 64.0f;
    struct {
        float dx, dy, taps, lod;
    } const cases[] = {
        {1.0f, 1.0f, 1.0f, 0.0f}, {0.25f, 0.25f, 1.0f, 0.0f}, {4.0f, 4.0f, 1.0f, 2.0f}, {8.0f, 2.0f, 4.0f, 1.0f},
        {2.0f, 8.0f, 4.0f, 1.0f}, {64.0f, 2.0f, 16.0f, 2.0f}, {3.0f, 0.0f, 3.0f, 0.0f}, {5.0f, 2.0f, 3.0f, 1.0f},
        {0.0f, 0.0f, 1.0f, 0.0f}, {1e3f, 1e3f, 1.0f, 6.0f},
    };
    std::vector<float> uv(6 * 16, 0.0f);
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        uv[2 * 16 + i] = cases[i].dx * n;
        uv[5 * 16 + i] = cases[i].dy * n;
    }
    const std::vector<float> out = results(float_fns()[0], "footprint", uv, view_of(p));
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        EXPECT_NEAR(out[2 * i], cases[i].lod, 1e-5f) << i;
        EXPECT_EQ(out[2 * i + 1], cases[i].taps) << i;
    }
}

TEST(texture_filter, derivatives_that_are_not_finite_read_the_smallest_level_once)
{
    const TexturePyramid p = noise_pyramid(64, 16, WrapMode::repeat, WrapMode::clamp);
    const double bad[] = {kNan, kInf, -kInf, 1e30, 3e38};
    std::vector<float> uv(6 * 16, 0.001f);
    for (std::size_t i = 0; i < std::size(bad); ++i)
        for (std::size_t c = 0; c < 3; ++c) // one of three derivatives is bad
            uv[(2 + c) * 16 + 3 * i + c] = static_cast<float>(bad[i]);
    for (const IsaFns& isa : float_fns()) {
        const std::vector<float> lod_taps = results(isa, "footprint", uv, view_of(p)), rgba = results(isa, "texture", uv, view_of(p));
        for (std::size_t i = 0; i < 15; ++i) {
            EXPECT_EQ(lod_taps[2 * i], static_cast<float>(p.levels - 1)) << i;
            EXPECT_EQ(lod_taps[2 * i + 1], 1.0f) << i;
            EXPECT_NEAR(rgba[4 * i], static_cast<float>(naive_texel(p, p.levels - 1, 0, 0, 0)), 1e-3f) << i;
        }
    }
}

TEST(texture_filter, coordinates_that_are_not_finite_stay_inside)
{
    const double bad[] = {kNan, kInf, -kInf, 1e30, -3e38, 16777216.0, -1e-9, 0x1.fffffep-1};
    for (const WrapMode mode : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror})
        for (const bool nearest : {false, true}) {
            const TexturePyramid p = noise_pyramid(5, 3, mode, mode, nearest);
            std::vector<float> uv(6 * 16, 0.01f);
            for (std::size_t i = 0; i < 16; ++i)
                uv[(i / 8) * 16 + i] = static_cast<float>(bad[i % 8]);
            for (const IsaFns& isa : float_fns())
                for (const float v : results(isa, "texture_exact", uv, view_of(p)))
                    EXPECT_TRUE(v >= 0.0f && v <= 1.0001f);
        }
}

TEST(texture_filter, nearest_reads_the_texel_that_contains_the_point)
{
    for (const WrapMode mode : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror}) {
        const TexturePyramid p = noise_pyramid(9, 6, mode, mode, true);
        const std::vector<float> uv = sample_positions(p);
        const std::vector<float> rgba = results(float_fns()[0], "texture_exact", uv, view_of(p));
        for (std::size_t i = 0; i < kSamples; ++i) {
            const double x = static_cast<double>(uv[i]) * 9.0, y = static_cast<double>(uv[kSamples + i]) * 6.0;
            if (std::fabs(x - std::round(x)) < 1e-4 || std::fabs(y - std::round(y)) < 1e-4)
                continue; // on an edge either side is right
            EXPECT_EQ(static_cast<double>(rgba[4 * i + 1]),
                      naive_texel(p, 0, static_cast<long>(std::floor(x)), static_cast<long>(std::floor(y)), 1));
        }
    }
}

TEST(texture_filter, a_constant_texture_stays_constant)
{
    Image image = make_image(23, 11, 4, PixelType::u8);
    std::fill(image.bytes.begin(), image.bytes.end(), static_cast<std::byte>(128));
    const TexturePyramid p = make_texture_pyramid(image, {}, TextureEncoding::linear);
    const std::vector<float> uv = sample_positions(p);
    const std::vector<float> rgba = results(float_fns()[0], "texture_exact", uv, view_of(p));
    const float expected = half_to_float(float_to_half(128.0f / 255.0f));
    for (const float v : rgba)
        ASSERT_NEAR(v, expected, 4e-7f);
}

TEST(texture_filter, every_instruction_set_and_loop_bound_gives_the_same_bits)
{
    const TexturePyramid p = noise_pyramid(61, 40, WrapMode::repeat, WrapMode::mirror);
    const std::vector<float> uv = sample_positions(p);
    const std::vector<float> expected = results(float_fns()[0], "texture_exact", uv, view_of(p));
    for (const IsaFns& isa : float_fns())
        for (const char* name : {"texture_exact", "texture"}) {
            const std::vector<float> got = results(isa, name, uv, view_of(p));
            EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)), 0) << isa.name << " " << name;
        }
}

} // namespace
} // namespace burnish
