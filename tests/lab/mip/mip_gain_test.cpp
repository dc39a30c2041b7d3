// Albedo gains of mip levels, and the lane code that makes levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/simd/dispatch.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/level_gains.h"
#include "shading/bake/mip/mean_fns.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mipnet/albedo_fns.h"
#include "shading/bake/mipnet/net.h"
#include "shading/lab/mipnet/families.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

using mipnet::Texels;
constexpr mipnet::Lobe kLobes[] = {mipnet::Lobe::ggx_aniso, mipnet::Lobe::beckmann, mipnet::Lobe::ashikhmin_shirley};

// Returns level 0 and the following levels of a filter.
std::vector<Texels> pyramid_of(const Texels& level0, MipFilter filter, std::size_t levels)
{
    std::vector<Texels> all = {level0};
    for (const MipLevel& level : make_mean_levels(rows_of_texels(level0), filter, 0.7f, Jobs(1)))
        if (all.size() <= levels)
            all.push_back(mip_level_texels(level));
    return all;
}

// Returns ridges of two slopes along x, with two widths.
Texels ridges(int side, float slope, float alpha)
{
    Texels t = mipnet::make_texels(side, side);
    for (std::size_t i = 0; i < t.count(); ++i)
        t.channel[0][i] = i % 2 == 0 ? slope : -slope,
        t.channel[2][i] = t.channel[3][i] = i / static_cast<std::size_t>(side) % 2 ? alpha : 0.5f * alpha;
    return t;
}

TEST(mip_gain, is_one_where_levels_are_as_level_0)
{
    for (const mipnet::Lobe lobe : kLobes)
        for (const bool metal : {true, false}) {
            Texels flat = ridges(64, 0.0f, 0.4f);
            flat.channel[2].assign(flat.count(), 0.3f), flat.channel[3].assign(flat.count(), 0.1f);
            for (const float gain : level_gains(pyramid_of(flat, kMipFilter_kappa, 4), mip_error_surface(lobe, metal)))
                EXPECT_NEAR(gain, 1.0f, 1e-4f);
        }
}

// Steep ridges make a level too bright or too dark. With its gain the level reflects as much as level 0, under other directions than the
// fit's.
TEST(mip_gain, makes_levels_reflect_as_much_as_level_0)
{
    double plain = 0.0;
    for (const mipnet::Lobe lobe : kLobes)
        for (const bool metal : {true, false})
            for (const MipFilter filter : {kMipFilter_baseline, kMipFilter_kappa}) {
                const std::vector<Texels> levels = pyramid_of(ridges(64, 0.6f, 0.5f), filter, 3);
                const std::vector<Texels> judged(levels.begin() + 1, levels.end());
                const MipErrorSurface surface = mip_error_surface(lobe, metal);
                const auto errors =
                    mip_errors(levels[0], {judged, judged}, surface, Jobs(2), {.first = 7000, .times = 400, .tiles = 8, .lamps = 0}, {},
                               {{}, level_gains(levels, surface)});
                for (std::size_t l = 0; l < judged.size(); ++l) {
                    EXPECT_NEAR(errors[1][l].light, 1.0, 0.035)
                        << mipnet::lobe_name(lobe) << (metal ? " metal " : " ") << static_cast<int>(filter) << " level " << l + 1;
                    plain = std::max(plain, std::abs(errors[0][l].light - 1.0));
                }
            }
    EXPECT_GT(plain, 0.1) << "nothing is to be mended";
}

TEST(mip_gain, passes_no_reflectance_beyond_1)
{
    EXPECT_EQ(gained({mipnet::Lobe::ggx_aniso, 0.85f, 0.0f}, 2.0f).f0, 1.0f);
    EXPECT_EQ(gained({mipnet::Lobe::ggx_aniso, 0.04f, 0.5f}, 1.5f).diffuse, 0.75f);
    EXPECT_EQ(gained({mipnet::Lobe::ggx_aniso, 0.04f, 0.5f}, 1.5f).f0, 0.06f);
}

// The gain averages over lights from anywhere, and does not depend on how test lights are drawn.
TEST(mip_gain, is_of_light_from_everywhere)
{
    const mipnet::Material m = mipnet::make_material(mipnet::families().front(), 3, 64);
    for (const mipnet::Lobe lobe : kLobes) {
        const std::vector<Texels> levels = pyramid_of(m.texels, kMipFilter_kappa, 3);
        const MipErrorSurface surface = mip_error_surface(lobe, m.metal);
        const std::vector<Texels> judged(levels.begin() + 1, levels.end());
        const auto errors = mip_errors(levels[0], {judged}, surface, Jobs(2), {.first = 7000, .times = 400, .tiles = 8, .lamps = 0});
        const std::vector<float> gains = level_gains(levels, surface);
        for (std::size_t l = 0; l < judged.size(); ++l)
            EXPECT_NEAR(static_cast<double>(gains[l]) * errors[0][l].light, 1.0, 0.04) << mipnet::lobe_name(lobe) << " level " << l + 1;
    }
}

// A matte surface under equal light from all sides of the eye. The gain in frames is the ratio of mean cosines. Gains for
// judged levels are lower.
TEST(mip_gain, of_frames_does_not_know_the_eye)
{
    const float slope = 0.6f, z = 0.8f;
    const std::vector<Texels> levels = pyramid_of(ridges(64, slope, 0.5f), kMipFilter_kappa, 2);
    const std::vector<LevelSize> sizes = {{64, 64}, {32, 32}, {16, 16}};
    const auto texels = [&](int l, std::size_t count, const int* x, const int* y, float* planes) {
        for (std::size_t c = 0; c < mipnet::kChannels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                *planes++ = levels[static_cast<std::size_t>(l)]
                                .channel[c][static_cast<std::size_t>(y[i] * sizes[static_cast<std::size_t>(l)].width + x[i])];
    };
    const MipErrorSurface matt = {mipnet::Lobe::ggx_aniso, 0.0f, 0.5f};
    double lit = 0.0, level = 0.0; // mean cosines over lights
    for (int i = 0; i < 2000; ++i)
        for (int j = 0; j < 200; ++j) {
            const double lz = 0.1 + 0.9 * (i + 0.5) / 2000.0,
                         lx = std::sqrt(1.0 - lz * lz) * std::cos(2.0 * 3.14159265358979 * (j + 0.5) / 200.0);
            lit += std::max(static_cast<double>(slope) * lx + static_cast<double>(z) * lz, 0.0), level += lz;
        }
    for (const float gain : level_gains(sizes, texels, matt, Gains::of_frames))
        EXPECT_NEAR(gain, lit / level, 0.02);
    for (const float gain : level_gains(sizes, texels, matt, Gains::as_judged))
        EXPECT_LT(gain, 0.97 * lit / level);
}

std::vector<float> numbers(std::size_t count, double least, double most, std::uint64_t seed)
{
    Random random(seed);
    std::vector<float> all(count);
    for (float& x : all)
        x = random.in(least, most);
    return all;
}

TEST(mip_gain, has_the_same_bits_for_every_instruction_set)
{
    const Texels t = mipnet::make_material(mipnet::families()[1], 5, 64).texels;
    std::vector<float> planes, drawn = numbers(mipnet::kDrawnNumbers * t.count(), -0.9, 0.9, 3);
    for (const std::vector<float>& channel : t.channel)
        planes.insert(planes.end(), channel.begin(), channel.end());
    for (const mipnet::Lobe lobe : kLobes) {
        std::vector<std::vector<float>> found;
        for (const Isa isa : isas_with<mipnet::AlbedoFns>()) {
            std::vector<float> out(2 * t.count());
            find_fns<mipnet::AlbedoFns>(isa)->albedo(
                {lobe, t.count(), 0.04f, 0.5f, false, planes.data(), drawn.data(), t.count(), out.data(), out.data() + t.count()});
            found.push_back(out);
            EXPECT_EQ(std::memcmp(out.data(), found[0].data(), out.size() * sizeof(float)), 0) << isa_name(isa);
        }
        EXPECT_GT(found.size(), 1u);
    }
}

TEST(mip_gain, is_kept_in_files_and_refused_where_it_is_none)
{
    const Texels t = ridges(16, 0.6f, 0.5f);
    MipLevels made;
    made.filter = kMipFilter_kappa, made.width = made.height = 16, made.gained = gained_of(mipnet::Lobe::beckmann, true);
    made.levels = make_mean_levels(rows_of_texels(t), kMipFilter_kappa, 0.7f, Jobs(1));
    for (std::size_t l = 0; l < made.levels.size(); ++l)
        made.levels[l].gain = 0.9f - 0.1f * static_cast<float>(l);
    const Result<MipFile> read = parse_mip_file(mip_file_bytes({{&made}, 0, {}}), "x.mip");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->materials[0].gained, made.gained);
    EXPECT_TRUE(gained_metal(read->materials[0].gained));
    EXPECT_FALSE(gained_metal(gained_of(mipnet::Lobe::beckmann, false)));
    for (std::size_t l = 0; l < made.levels.size(); ++l)
        EXPECT_EQ(read->materials[0].levels[l].gain, made.levels[l].gain);
    for (const float wrong : {0.0f, 2.5f, std::nanf("")}) {
        MipLevels bad = made;
        bad.levels[1].gain = wrong;
        EXPECT_FALSE(parse_mip_file(mip_file_bytes({{&bad}, 0, {}}), "x.mip")) << wrong;
    }
    MipLevels bad = made;
    bad.gained = 0;
    EXPECT_FALSE(parse_mip_file(mip_file_bytes({{&bad}, 0, {}}), "x.mip")) << "gains of nothing";
}

// Rows of any length, maps with three and four channels: states, squares, texels, tensors and hashes.
TEST(mip_lanes, have_the_same_bits_for_every_instruction_set)
{
    std::vector<std::uint8_t> codes(4 * 150);
    Random random(9);
    for (std::uint8_t& code : codes)
        code = static_cast<std::uint8_t>(random.in(0.0, 255.9));
    for (const std::size_t count : {std::size_t{1}, std::size_t{37}, std::size_t{150}})
        for (const int channels : {3, 4})
            for (const mip::Mean mean : {mip::Mean::baseline, mip::Mean::covariance, mip::Mean::leadr, mip::Mean::ssgt, mip::Mean::kappa}) {
                std::vector<std::vector<float>> found;
                for (const Isa isa : isas_with<mip::Fns>()) {
                    const mip::Fns& fns = *find_fns<mip::Fns>(isa);
                    const std::size_t stride = mip::row_stride(count), half = std::max<std::size_t>(count / 2, 1),
                                      to = mip::row_stride(half);
                    std::vector<float> points(mip::kPointPlanes * stride), rough(stride), tensors = numbers(6 * stride, 0.0, 0.5, 4);
                    fns.codes({codes.data(), channels, 0, 3, count, stride, points.data()});
                    for (std::size_t x = 0; x < count; ++x)
                        EXPECT_EQ(points[stride + x], static_cast<float>(codes[static_cast<std::size_t>(channels) * x + 1]) / 255.0f);
                    fns.normals({count, stride, 0.8f, points.data()});
                    fns.codes({codes.data(), channels, 1, 1, count, stride, rough.data()});
                    fns.covariances({count, stride, rough.data(), tensors.data(), 0.9f, 0.7f, 0.6f, 0.8f, points.data() + 3 * stride});
                    for (std::size_t k = 0; k < mip::kPointPlanes; ++k)
                        std::fill_n(points.data() + k * stride + count, stride - count, 0.0f);
                    std::vector<float> states(mip::kMostStates * stride), merged(mip::kMostStates * to), out(mip::kLobeChannels * half);
                    fns.states({mean, count, stride, points.data(), states.data()});
                    fns.merge({mean, 0.7f, half, to, states.data(), states.data(), stride, count > 1 ? 2 : 1, merged.data()});
                    fns.texels({mean, half, to, merged.data(), out.data()});
                    std::vector<float> own(mip::kLobeChannels * stride);
                    fns.tensors({count, stride, points.data(), own.data()});
                    for (std::size_t c = 0; c < mip::kLobeChannels; ++c)
                        out.insert(out.end(), own.begin() + static_cast<std::ptrdiff_t>(c * stride),
                                   own.begin() + static_cast<std::ptrdiff_t>(c * stride + count));
                    std::vector<float> mixed(mip::kPointPlanes * mip::kRowSlots);
                    fns.hash({stride, points.data(), reinterpret_cast<std::uint32_t*>(mixed.data())});
                    out.insert(out.end(), mixed.begin(), mixed.end());
                    found.push_back(out);
                    EXPECT_EQ(std::memcmp(out.data(), found[0].data(), out.size() * sizeof(float)), 0)
                        << isa_name(isa) << " " << count << " mean " << static_cast<int>(mean);
                }
                EXPECT_GT(found.size(), 1u);
            }
}

// A changed number in a row changes the hash at every position, and so do two swapped numbers.
TEST(mip_lanes, hashes_see_every_number)
{
    const std::size_t stride = 48;
    const std::vector<float> points = numbers(mip::kPointPlanes * stride, -1.0, 1.0, 8);
    const auto hashed = [&](const std::vector<float>& of) {
        std::vector<std::uint32_t> mixed(mip::kPointPlanes * mip::kRowSlots);
        pick<mip::Fns>().hash({stride, of.data(), mixed.data()});
        return mixed;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::vector<float> other = points;
        other[i] = std::nextafter(other[i], 2.0f);
        EXPECT_NE(hashed(other), hashed(points)) << i;
        if (i % stride + mip::kRowSlots < stride) {
            other = points;
            std::swap(other[i], other[i + mip::kRowSlots]);
            EXPECT_NE(hashed(other), hashed(points)) << i;
        }
    }
}

} // namespace
} // namespace burnish
