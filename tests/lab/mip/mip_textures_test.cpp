// Levels as textures for other programs, their precision in halves, and errors of levels against the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/image/metrics/flip.h"
#include "core/simd/dispatch.h"
#include "core/simd/half.h"
#include "shading/bake/mip/colour_levels.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mip/optimised_mip.h"
#include "shading/bake/mip/standard_textures.h"
#include "shading/bake/mip/texture.h"
#include "shading/lab/mipnet/families.h"
#include "shading/lang/records.h"
#include "shading/surface/tensor.k.h"
#include "tests/lab/mip/flat_texels.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

struct TexturedMaterial {
    Image normal, roughness, direction;
    MipMaps maps() const
    {
        MipMaps m;
        m.normal = &normal, m.roughness = &roughness, m.direction = &direction, m.anisotropy_strength = 0.9f, m.anisotropy_rotation = 0.3f;
        return m;
    }
};

TexturedMaterial some_material(int width, int height, double lean)
{
    Random random(17);
    TexturedMaterial m;
    for (Image* image : {&m.normal, &m.roughness, &m.direction})
        *image = make_image(width, height, 3, PixelType::f32);
    for (std::size_t i = 0; i < static_cast<std::size_t>(width * height); ++i) {
        const float x = random.in(-lean, lean), y = random.in(-lean, lean), turn = random.in(0.0, 6.2);
        const float n[3] = {0.5f + 0.5f * x, 0.5f + 0.5f * y, 0.5f + 0.5f * std::sqrt(1.0f - x * x - y * y)};
        const float d[3] = {0.5f + 0.5f * std::cos(turn), 0.5f + 0.5f * std::sin(turn), random.in(0.2, 0.8)};
        std::copy_n(n, 3, m.normal.f32() + 3 * i), std::copy_n(d, 3, m.direction.f32() + 3 * i);
        m.roughness.f32()[3 * i + 1] = random.in(0.2, 0.6);
    }
    return m;
}

double most_off(const mipnet::Texels& a, const mipnet::Texels& b)
{
    double most = 0.0;
    for (std::size_t c = 0; c < mipnet::kChannels; ++c)
        for (std::size_t i = 0; i < a.count(); ++i)
            most = std::max(most, std::abs(static_cast<double>(a.channel[c][i]) - static_cast<double>(b.channel[c][i])));
    return most;
}

TEST(mip_textures, hold_every_lobe_at_its_texel)
{
    const TexturedMaterial material = some_material(17, 8, 0.4);
    const MipSource source(material.maps());
    for (std::size_t f = 0; f < mip_filters().size(); ++f) {
        if (!makes_lobes(static_cast<MipFilter>(f)))
            continue;
        const MipLevels levels = make_mip_levels(source, static_cast<MipFilter>(f), 0.7f, Jobs(1));
        const StandardLevels held = standard_levels(source, levels, {}, 0.25f);
        ASSERT_EQ(held.normal.size(), levels.levels.size() + 1);
        EXPECT_EQ(held.roughness[2].f32()[2], 0.25f);
        for (std::size_t l = 0; l < held.normal.size(); ++l) {
            EXPECT_LT(most_off(standard_texels(held, l, false), filtered_texels(source, levels, l, false)), 2e-4)
                << mip_filters()[f].name << l;
            for (const Image* map : {&held.normal[l], &held.roughness[l], &held.anisotropy[l]})
                for (std::size_t i = 0; i < map->bytes.size() / sizeof(float); ++i)
                    ASSERT_TRUE(map->f32()[i] >= 0.0f && map->f32()[i] <= 1.0f);
        }
        const mipnet::Texels between = filtered_texels(source, levels, 0, true);
        EXPECT_EQ(between.width, 16);
        EXPECT_GT(most_off(standard_texels(held, 0, true), between), 1e-2); // random directions and widths do not average linearly
    }
}

// One tilted lobe: its textures lose nothing between texels, as all texels are equal.
TEST(mip_textures, of_one_value_lose_nothing_between_texels)
{
    TexturedMaterial material = some_material(8, 8, 0.4);
    for (Image* image : {&material.normal, &material.roughness, &material.direction})
        for (std::size_t i = 1; i < 64; ++i)
            std::copy_n(image->f32(), 3, image->f32() + 3 * i);
    const MipSource source(material.maps());
    const MipLevels levels = make_mip_levels(source, kMipFilter_kappa, 0.7f, Jobs(1));
    const StandardLevels held = standard_levels(source, levels, {}, 0.0f);
    for (std::size_t l = 0; l < held.normal.size(); ++l)
        EXPECT_LT(most_off(standard_texels(held, l, true), filtered_texels(source, levels, l, true)), 2e-4);
}

// Frames hold a half and its rounding remainder: alpha is within 0.05 % down to the narrowest lobe, where normals are level.
TEST(mip_textures, halves_keep_the_narrowest_lobes)
{
    const Texture sampler;
    for (const float alpha : {0.002f, 0.0031f, 0.02f, 0.7f}) {
        const float moment = kMomentScale * 0.5f * alpha * alpha;
        float found = 0.0f;
        for (const TextureEncoding encoding : {TextureEncoding::linear, TextureEncoding::residual}) {
            const TexturePyramid p =
                make_texture_pyramid(1, 1, sampler, encoding, [&](int, int, int, float* rgba) { std::fill_n(rgba, 4, moment); });
            found += half_to_float(p.texels[4 * 4]); // the middle of 3 x 3 with its border
        }
        EXPECT_NEAR(std::sqrt(2.0f * found / kMomentScale), alpha, 5e-4f * alpha) << alpha;
    }
}

// Returns a number as frames hold it: as a half, or as a half plus a second half for the rounding remainder.
float held(float value, bool residual)
{
    const float first = half_to_float(float_to_half(value));
    return residual ? first + half_to_float(float_to_half(value - first)) : first;
}

// Returns levels as frames hold them: normals and covariances as one half or two.
mipnet::Texels in_halves(const mipnet::Texels& from, bool residual)
{
    mipnet::Texels to = from;
    for (std::size_t i = 0; i < from.count(); ++i) {
        const slope_covariance s = covariance_of_tensor({from.channel[2][i], from.channel[3][i], from.channel[4][i]});
        const auto moment = [&](float value) { return held(kMomentScale * value, residual) / kMomentScale; };
        const lobe_tensor t = projected_tensor(tensor_of_covariance({moment(s.xx), moment(s.yy), moment(s.xy)}));
        for (std::size_t c = 0; c < 2; ++c)
            to.channel[c][i] = held(kSlopeScale * from.channel[c][i], residual) / kSlopeScale;
        to.channel[2][i] = t.a, to.channel[3][i] = t.b, to.channel[4][i] = t.c;
    }
    return to;
}

double flip_between(const mipnet::Texels& a, const mipnet::Texels& b, mipnet::Lobe lobe)
{
    const auto picture = [&](const mipnet::Texels& t) {
        std::vector<float> planes, to_light, to_eye, intensity(t.count(), 5.0f), out(t.count());
        for (const std::vector<float>& channel : t.channel)
            planes.insert(planes.end(), channel.begin(), channel.end());
        for (const float part : {0.28f, 0.0f, 0.96f})
            to_light.insert(to_light.end(), t.count(), part);
        for (const float part : {-0.28f, 0.0f, 0.96f})
            to_eye.insert(to_eye.end(), t.count(), part);
        pick<mipnet::Fns>().radiance(
            {lobe, t.count(), planes.data(), to_light.data(), to_eye.data(), intensity.data(), 0.85f, 0.0f, out.data()});
        Image image = make_image(t.width, t.height, 3, PixelType::f32);
        for (std::size_t i = 0; i < 3 * t.count(); ++i)
            image.f32()[i] = out[i / 3] / (1.0f + out[i / 3]);
        return image;
    };
    const Image error = flip_ldr(picture(a), picture(b), {}, Jobs(1)).error;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.count(); ++i)
        sum += static_cast<double>(error.f32()[i]);
    return sum / static_cast<double>(a.count());
}

// Holds for all lobe widths. `cli.mip.normals_of_levels_are_as_fine_as_floats` tests frames.
TEST(mip_textures, in_halves_look_as_in_floats)
{
    double most_of_one_half = 0.0;
    for (const float alpha : {0.002f, 0.01f, 0.05f, 0.3f}) {
        mipnet::Texels relief = mipnet::make_material(mipnet::families().front(), 3, 64).texels;
        for (std::size_t i = 0; i < relief.count(); ++i) {
            relief.channel[0][i] *= 0.3f, relief.channel[1][i] *= 0.3f;
            relief.channel[2][i] = alpha, relief.channel[3][i] = 2.0f * alpha, relief.channel[4][i] = 0.0f;
        }
        const mipnet::Texels level = mip_level_texels(make_mean_levels(rows_of_texels(relief), kMipFilter_covariance, 0.0f, Jobs(1))[0]);
        for (const mipnet::Lobe lobe : {mipnet::Lobe::ggx_aniso, mipnet::Lobe::beckmann, mipnet::Lobe::ashikhmin_shirley}) {
            EXPECT_LT(flip_between(level, in_halves(level, true), lobe), 1e-3) << alpha;
            most_of_one_half = std::max(most_of_one_half, flip_between(level, in_halves(level, false), lobe));
        }
    }
    EXPECT_GT(most_of_one_half, 1e-3) << "a second half is not needed";
}

TEST(mip_error, errors_are_those_of_what_differs)
{
    const MipErrorSurface surface = mip_error_surface(mipnet::Lobe::ggx_aniso, true);
    const std::vector<mipnet::Texels> same = {flat_texels(32, 0.3f), flat_texels(16, 0.3f), flat_texels(8, 0.3f)};
    std::vector<mipnet::Texels> wider = {flat_texels(32, 0.31f), flat_texels(16, 0.4f), flat_texels(8, 0.6f)};
    const auto errors = mip_errors(flat_texels(64, 0.3f), {same, wider}, surface, Jobs(1));
    for (std::size_t l = 0; l < 3; ++l) {
        EXPECT_EQ(errors[0][l].l1 + errors[0][l].mse, 0.0);
        EXPECT_LE(errors[0][l].flip, 0.1 * errors[1][l].flip) << "lamps are near, their light is not the same everywhere";
        EXPECT_GT(errors[1][l].l1, l == 0 ? 1e-4 : 4.0 * errors[1][l - 1].l1 * (l == 1 ? 1.0 : 0.4));
        EXPECT_GE(errors[1][l].mse, errors[1][l].l1 * errors[1][l].l1);
        EXPECT_EQ(errors[1][l].flip > 0.0, l < 2) << "squares of 16 texels and more have one";
        EXPECT_NEAR(mip_difference(same[l], wider[l], surface).l1, errors[1][l].l1, 1e-6) << "of a level that is the reference";
    }
    const auto other = mip_errors(flat_texels(64, 0.3f), {same, wider}, surface, Jobs(1), {.first = 48, .times = 24, .lamps = 0});
    EXPECT_EQ(other[1][0].flip, 0.0);
    EXPECT_NE(other[1][1].l1, errors[1][1].l1) << "other pairs";
    EXPECT_NEAR(other[1][1].l1 / errors[1][1].l1, 1.0, 0.5);
}

TEST(mip_error, tiles_have_pairs_of_their_own)
{
    // Each tile holds one level texel and uses its own pair of directions. All tiles together give the mean over the pairs.
    const MipErrorSurface surface = mip_error_surface(mipnet::Lobe::beckmann, false);
    const std::vector<std::vector<mipnet::Texels>> wider = {{flat_texels(4, 0.4f)}};
    const mipnet::Texels level0 = flat_texels(8, 0.3f);
    const double tiled = mip_errors(level0, wider, surface, Jobs(1), {.first = 5, .times = 3, .tiles = 4, .lamps = 0})[0][0].l1;
    const double whole = mip_errors(level0, wider, surface, Jobs(1), {.first = 5, .times = 48, .lamps = 0})[0][0].l1;
    EXPECT_NEAR(tiled, whole, 1e-6);
    EXPECT_NE(tiled, mip_errors(level0, wider, surface, Jobs(1), {.first = 6, .times = 3, .tiles = 4, .lamps = 0})[0][0].l1);
}

TEST(mip_error, errors_do_not_depend_on_threads)
{
    const mipnet::Material m = mipnet::make_material(mipnet::families().front(), 3, 64);
    std::vector<std::vector<mipnet::Texels>> filters;
    for (const MipFilter filter : {kMipFilter_baseline, kMipFilter_leadr, kMipFilter_ssgt}) {
        filters.emplace_back();
        for (const MipLevel& level : make_mean_levels(rows_of_texels(m.texels), filter, 0.0f, Jobs(1)))
            filters.back().push_back(mip_level_texels(level));
        filters.back().resize(3);
    }
    const MipErrorSurface surface = mip_error_surface(mipnet::Lobe::ggx_aniso, m.metal);
    const auto one = mip_errors(m.texels, filters, surface, Jobs(1)), three = mip_errors(m.texels, filters, surface, Jobs(3));
    for (std::size_t f = 0; f < filters.size(); ++f)
        for (std::size_t l = 0; l < 3; ++l) {
            EXPECT_EQ(one[f][l].l1, three[f][l].l1);
            EXPECT_EQ(one[f][l].mse, three[f][l].mse);
            EXPECT_EQ(one[f][l].flip, three[f][l].flip);
        }
    EXPECT_NE(one[0][0].l1, one[1][0].l1);
}

// Two alternating slopes: from starts far off, the search finds their mean and a wider lobe, and keeps a start that is right.
TEST(mip_optimiser, ends_nearer_to_level_0_than_it_began)
{
    const Jobs jobs(2);
    for (const mipnet::Lobe lobe : {mipnet::Lobe::ggx_aniso, mipnet::Lobe::beckmann, mipnet::Lobe::ashikhmin_shirley}) {
        const MipErrorSurface surface = mip_error_surface(lobe, true);
        mipnet::Texels relief = flat_texels(64, 0.15f);
        for (std::size_t i = 0; i < relief.count(); ++i)
            relief.channel[0][i] = (i & 1) != 0 ? 0.12f : -0.06f;
        const std::vector<std::vector<mipnet::Texels>> starts = {{flat_texels(32, 0.15f), flat_texels(16, 0.15f)},
                                                                 {flat_texels(32, 0.8f), flat_texels(16, 0.8f)}};
        const std::vector<mipnet::Texels> optimised = optimised_levels(relief, starts, surface, jobs);
        const auto errors = mip_errors(relief, {starts[0], optimised}, surface, jobs, {.first = 1000, .times = 24, .lamps = 0});
        for (std::size_t l = 0; l < 2; ++l) {
            EXPECT_LT(errors[1][l].l1, 0.7 * errors[0][l].l1) << static_cast<int>(lobe);
            EXPECT_NEAR(optimised[l].channel[0][0], 0.03, 0.015);                      // the mean slope
            EXPECT_GT(optimised[l].channel[3][0], optimised[l].channel[2][0] + 0.01f); // wider along x, as b is
        }
        const std::vector<mipnet::Texels> kept =
            optimised_levels(flat_texels(8, 0.3f), {{flat_texels(4, 0.9f)}, {flat_texels(4, 0.3f)}}, surface, jobs);
        EXPECT_EQ(kept[0].channel[2], flat_texels(4, 0.3f).channel[2]);
    }
}

// Odd sides: texels below are shared out by area. Levels have equal bits for every thread count and instruction set.
TEST(mip_optimiser, takes_odd_sides_and_any_number_of_threads)
{
    const TexturedMaterial material = some_material(37, 21, 0.3);
    const MipSource source(material.maps());
    const MipLevels one = make_mip_levels(source, kMipFilter_teacher, 0.7f, Jobs(1)),
                    three = make_mip_levels(source, kMipFilter_teacher, 0.7f, Jobs(3));
    ASSERT_EQ(one.levels.size(), 5u);
    for (std::size_t l = 0; l < one.levels.size(); ++l)
        EXPECT_EQ(one.levels[l].texels, three.levels[l].texels);
    EXPECT_NE(one.levels[0].texels, make_mip_levels(source, kMipFilter_mipnet, 0.7f, Jobs(1)).levels[0].texels);
}

Image gray_map(int width, int height, const std::function<double(int x, int y)>& value)
{
    Image image = make_image(width, height, 1, PixelType::f32);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.f32()[y * width + x] = static_cast<float>(value(x, y));
    return image;
}

TEST(colour_levels, are_exact_means_by_box_and_keep_one_colour_by_both)
{
    for (const auto& [width, height] : {std::pair(257, 129), {1, 64}, {1, 1}, {6, 5}}) {
        Random random(3);
        double sum = 0.0;
        const Image map = gray_map(width, height, [&](int, int) { return random(); });
        for (int i = 0; i < width * height; ++i)
            sum += static_cast<double>(map.f32()[i]);
        const std::vector<Image> levels = colour_levels(map, {});
        EXPECT_EQ(levels.back().width * levels.back().height, 1);
        EXPECT_NEAR(levels.back().f32()[0], sum / (width * height), 1e-6);
        for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror})
            for (const Image& level :
                 colour_levels(gray_map(width, height, [](int, int) { return 0.3; }), {ColourKernel::kaiser, wrap, wrap}))
                for (int i = 0; i < level.width * level.height; ++i)
                    ASSERT_NEAR(level.f32()[i], 0.3, 1e-6);
    }
}

// Waves with each period: waves that the level resolves stay, and others vanish.
TEST(colour_levels, by_kaiser_are_sharper_and_have_less_that_is_false)
{
    const auto left = [](double period, ColourKernel kernel) {
        const Image map = gray_map(256, 1, [&](int x, int) { return 0.5 + 0.4 * std::cos(2.0 * 3.14159265358979 * (x + 0.5) / period); });
        const Image level = colour_levels(map, {kernel})[1];
        double square = 0.0;
        for (int i = 0; i < level.width; ++i)
            square += std::pow(static_cast<double>(level.f32()[i]) - 0.5, 2.0) / level.width;
        return std::sqrt(2.0 * square) / 0.4;
    };
    EXPECT_GT(left(8.0, ColourKernel::kaiser), 0.97);
    EXPECT_LT(left(8.0, ColourKernel::box), 0.93);
    EXPECT_LT(left(2.56, ColourKernel::kaiser), 0.05);
    EXPECT_GT(left(2.56, ColourKernel::box), 0.3);
}

// A metal with flat ridges in one colour and steep ridges in another. The test finds the steep ridges' part in the mean radiance.
TEST(colour_levels, that_are_coupled_have_less_than_half_the_error_of_colour)
{
    constexpr int kSide = 8;
    mipnet::Texels t = mipnet::make_texels(kSide, kSide);
    Image facing = gray_map(kSide, kSide, [](int, int) { return 1.0; }), steep = facing;
    for (std::size_t i = 0; i < t.count(); ++i) {
        const float nx = i % 2 == 0 ? 0.0f : i % 4 == 1 ? 0.8f : -0.8f;
        t.channel[0][i] = nx, t.channel[2][i] = t.channel[3][i] = 0.3f;
        facing.f32()[i] = 1.0f - nx * nx, steep.f32()[i] = nx == 0.0f ? 0.0f : 1.0f;
    }
    std::vector<float> planes;
    for (const std::vector<float>& channel : t.channel)
        planes.insert(planes.end(), channel.begin(), channel.end());
    Random random(23);
    double of_steep = 0.0, of_all = 0.0;
    for (int pair = 0; pair < 4000; ++pair) { // eyes and lights weighted by their cosines
        std::vector<float> to[2], intensity(t.count(), 1.0f), out(t.count());
        for (std::vector<float>& d : to) {
            const double r = std::sqrt(random()), turn = 6.283185307 * random();
            for (const double part : {r * std::cos(turn), r * std::sin(turn), std::sqrt(1.0 - r * r)})
                d.insert(d.end(), t.count(), static_cast<float>(part));
        }
        pick<mipnet::Fns>().radiance(
            {mipnet::Lobe::ggx_aniso, t.count(), planes.data(), to[0].data(), to[1].data(), intensity.data(), 1.0f, 0.0f, out.data()});
        for (std::size_t i = 0; i < t.count(); ++i)
            of_all += static_cast<double>(out[i]), of_steep += static_cast<double>(out[i] * steep.f32()[i]);
    }
    const double reference = of_steep / of_all, box = static_cast<double>(colour_levels(steep, {}).back().f32()[0]);
    const double coupled = static_cast<double>(colour_levels(steep, {.weight = &facing}).back().f32()[0]);
    EXPECT_NEAR(box, 0.5, 1e-6);
    EXPECT_LT(std::abs(coupled - reference), 0.5 * std::abs(box - reference)) << reference << " coupled " << coupled;
}

} // namespace
} // namespace burnish
