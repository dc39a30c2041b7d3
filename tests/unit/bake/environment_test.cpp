#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/hash.h"
#include "core/image/io/image_io.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin/builtin.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/environment_cache.h"
#include "shading/bake/environment/equirect.h"
#include "shading/bake/environment/extracted_lights.h"
#include "shading/bake/environment/turn.h"
#include "tests/unit/bake/bake_test.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

Environment bake(const Image& image, const EnvironmentOptions& options, int threads = 2)
{
    Result<Environment> e = bake_environment(image, "test", options, Jobs(threads));
    EXPECT_TRUE(e) << (e ? "" : e.error().line());
    return e ? std::move(*e) : Environment{};
}

using Rgb = std::array<float, 3>;

Rgb fetch(const CubeMap& cube, double x, double y, double z, double lod = 0.0)
{
    const std::vector<float> at = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(lod)};
    const std::vector<float> rgb = results(float_fns()[0], "cube", at, view_of(cube));
    return {rgb[0] * cube.scale, rgb[1] * cube.scale, rgb[2] * cube.scale};
}

TEST(environment, a_constant_environment_is_constant_on_every_level_and_in_irradiance)
{
    for (const float value : {1.0f, 0.37f, 3e5f, 2e-4f}) {
        const Image image =
            equirect_of(64, [&](double, double, double, float* rgb) { rgb[0] = value, rgb[1] = 0.5f * value, rgb[2] = 0.0f; });
        const Environment e = bake(image, small_bake());
        ASSERT_EQ(e.specular.levels, 5);
        for (const CubeMap* cube : {&e.specular, &e.irradiance})
            for (std::size_t i = 0; i < cube->texels.size(); i += 4) {
                ASSERT_NEAR(half_to_float(cube->texels[i]) * cube->scale, value, value * 0x1p-11f) << "texel " << i / 4;
                ASSERT_NEAR(half_to_float(cube->texels[i + 1]) * cube->scale, 0.5f * value, value * 0x1p-12f);
                ASSERT_EQ(cube->texels[i + 2], 0);
                ASSERT_EQ(half_to_float(cube->texels[i + 3]), 1.0f);
            }
        EXPECT_NEAR(e.energy_cube, e.energy_source, e.energy_source * 5e-4);
    }
}

TEST(environment, every_texel_of_level_zero_looks_in_its_own_direction)
{
    const Environment e = bake(smooth_equirect(256), small_bake());
    const int n = e.specular.size;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < n * n; ++i) {
            const Direction d = cube_direction(face, (i % n + 0.5) * 2.0 / n - 1.0, (i / n + 0.5) * 2.0 / n - 1.0);
            const double r = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), x = d.x / r, y = d.y / r, z = d.z / r;
            const double expected[3] = {1.0 + 0.8 * x + 0.3 * y * z, 1.0 + 0.7 * y * y - 0.2 * x, 1.2 + z * (0.5 + 0.4 * x)};
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(static_cast<double>(cube_texel(e.specular, 0, face, i % n, i / n, c)), expected[c], 3e-3)
                    << "face " << face << " texel " << i << " channel " << c;
        }
}

// Returns an image with radiance 1 in red, green, blue around +x, +y, +z and half of it around the opposite axes.
Image axes_image()
{
    return equirect_of(128, [](double x, double y, double z, float* rgb) {
        const double axis[3] = {x, y, z};
        for (int c = 0; c < 3; ++c)
            rgb[c] = axis[c] > 0.8 ? 1.0f : axis[c] < -0.8 ? 0.5f : 0.0f;
    });
}

TEST(environment, coloured_axes_end_on_their_faces)
{
    const Environment e = bake(axes_image(), small_bake());
    EXPECT_EQ(fetch(e.specular, 1, 0, 0), (Rgb{1, 0, 0}));
    EXPECT_EQ(fetch(e.specular, -1, 0, 0), (Rgb{.5, 0, 0}));
    EXPECT_EQ(fetch(e.specular, 0, 1, 0), (Rgb{0, 1, 0}));
    EXPECT_EQ(fetch(e.specular, 0, -1, 0), (Rgb{0, .5, 0}));
    EXPECT_EQ(fetch(e.specular, 0, 0, 1), (Rgb{0, 0, 1}));
    EXPECT_EQ(fetch(e.specular, 0, 0, -1), (Rgb{0, 0, .5}));
}

TEST(environment, rotation_turns_counter_clockwise_seen_from_above)
{
    const auto at = [](float degrees, const glm::dvec3& direction) {
        const glm::dvec3 d = sky_from_world(degrees) * direction;
        return glm::round(d * 1e12) / 1e12;
    };
    EXPECT_EQ(at(90.0f, {0, 0, -1}), glm::dvec3(1, 0, 0)); // formerly at +x
    EXPECT_EQ(at(90.0f, {1, 0, 0}), glm::dvec3(0, 0, 1));  // formerly at +z
    EXPECT_EQ(at(90.0f, {0, 1, 0}), glm::dvec3(0, 1, 0));
    EXPECT_EQ(at(90.0f - 720.0f, {0, 0, -1}), glm::dvec3(1, 0, 0));
    ExtractedLight light = {};
    light.direction[0] = light.axis_u[1] = light.axis_v[2] = 1.0f;
    const ExtractedLight r = turned(light, 90.0f);
    EXPECT_NEAR(r.direction[2], -1.0f, 1e-6f);
    EXPECT_NEAR(r.axis_u[1], 1.0f, 1e-6f);
    EXPECT_NEAR(r.axis_v[0], 1.0f, 1e-6f);
}

TEST(environment, rotation_is_not_baked)
{
    EnvironmentOptions o = small_bake();
    const Environment plain = bake(axes_image(), o);
    o.rotation_deg = 90.0f;
    const Environment e = bake(axes_image(), o);
    EXPECT_EQ(e.rotation_deg, 90.0f);
    EXPECT_NE(e.content_hash, plain.content_hash);
    EXPECT_TRUE(std::equal(plain.specular.texels.begin(), plain.specular.texels.end(), e.specular.texels.begin()));
}

TEST(environment, the_centre_of_the_image_is_plus_x_and_u_runs_towards_plus_z)
{
    Image image = make_image(64, 32, 3, PixelType::f32);
    const auto mark = [&](int x, int y, int c) { // a spot of 4x4 pixels
        for (int j = -2; j < 2; ++j)
            for (int i = -2; i < 2; ++i)
                image.f32()[static_cast<std::size_t>(((y + j) * 64 + x + i) * 3 + c)] = 1.0f;
    };
    mark(32, 16, 0);
    mark(48, 16, 1);
    mark(32, 8, 2); // above the centre
    const Environment e = bake(image, small_bake());
    EXPECT_GT(fetch(e.specular, 1, 0, 0)[0], 0.9f);
    EXPECT_GT(fetch(e.specular, 0, 0, 1)[1], 0.9f);
    EXPECT_GT(fetch(e.specular, 1, 1, 0)[2], 0.9f);
}

// At the end of every axis the image shows black lines towards the other axes' positive ends. Its centre is +z and u runs from +x to +z, so
// a quarter turn maps every axis to its place.
TEST(environment, an_orientation_picture_lands_the_right_way_round_on_every_face)
{
    const Result<Image> image = read_image(test::data_file("env/OrientationLatLong_tiled_mip.exr"), Limits{});
    ASSERT_TRUE(image) << image.error().line();
    EnvironmentOptions o = small_bake();
    o.cube_size = 256;
    o.levels = 1;
    const Environment e = bake(*image, o);
    const glm::dmat3 to_sky = sky_from_world(-90.0f);
    const auto darkest_at = [&](const double* d) { // brightest channel of the darkest point around d
        float darkest = 1.0f;
        for (int k = 0; k < 27; ++k) {
            const double s = 0.006;
            const glm::dvec3 at = to_sky * glm::dvec3(d[0] + s * (k % 3 - 1), d[1] + s * (k / 3 % 3 - 1), d[2] + s * (k / 9 - 1));
            const Rgb c = fetch(e.specular, at.x, at.y, at.z);
            darkest = std::min(darkest, std::max({c[0], c[1], c[2]}));
        }
        return darkest;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double end : {1.0, -1.0})
            for (int other = 0; other < 3; ++other) {
                if (other == axis)
                    continue;
                double d[3] = {};
                d[axis] = end;
                d[other] = 0.12;
                const float towards = darkest_at(d);
                d[other] = -0.12;
                EXPECT_LT(towards + 0.05f, darkest_at(d)) << "end " << end << " of axis " << axis << ", other " << other;
                EXPECT_LT(towards, 0.5f);
            }
}

TEST(environment, a_sun_keeps_its_energy_wherever_it_stands)
{
    for (const int row : {1, 20, 77, 128, 200}) { // errors are large in the pole's row
        Image image = make_image(512, 256, 3, PixelType::f32);
        std::fill(image.f32(), image.f32() + image.bytes.size() / 4, 0.01f);
        for (int c = 0; c < 3; ++c)
            image.f32()[static_cast<std::size_t>((row * 512 + 301 + row) * 3 + c)] = 4e6f; // one pixel, far beyond half
        for (const int size : {16, 128}) {
            EnvironmentOptions o = small_bake();
            o.cube_size = size;
            o.levels = 2;
            o.samples = 1;
            const Environment e = bake(image, o);
            EXPECT_EQ(e.peak_source, 4e6f);
            EXPECT_NEAR(e.energy_cube / e.energy_source, 1.0, 5e-3) << "row " << row << ", cube of " << size;
        }
    }
}

TEST(environment, exposure_multiplies_radiance)
{
    EnvironmentOptions o = small_bake();
    const Environment plain = bake(smooth_equirect(64), o);
    o.exposure_ev = 3.0f;
    const Environment bright = bake(smooth_equirect(64), o);
    EXPECT_EQ(bright.specular.scale, 8.0f * plain.specular.scale);
    EXPECT_TRUE(std::equal(plain.specular.texels.begin(), plain.specular.texels.end(), bright.specular.texels.begin()));
    EXPECT_NEAR(bright.energy_source, 8.0 * plain.energy_source, 1e-9);
    EXPECT_NE(bright.content_hash, plain.content_hash);
}

// Irradiance / pi of spherical harmonics up to order 2: the bands are damped by 1, 2/3, 1/4 (Ramamoorthi, Hanrahan 2001).
TEST(environment, irradiance_of_low_order_harmonics_is_exact)
{
    EnvironmentOptions o = small_bake();
    o.cube_size = 64;
    const Environment e = bake(smooth_equirect(256), o);
    Random random(9);
    for (int i = 0; i < 200; ++i) {
        const double z = random() * 2.0 - 1.0, phi = random() * 6.283185307179586, rho = std::sqrt(1.0 - z * z);
        const double x = rho * std::cos(phi), y = rho * std::sin(phi);
        const double expected[3] = {1.0 + 0.8 * x * 2 / 3 + 0.3 * y * z / 4,
                                    1.0 + 0.7 * (1.0 / 3 + (y * y - 1.0 / 3) / 4) - 0.2 * x * 2 / 3,
                                    1.2 + 0.5 * z * 2 / 3 + 0.4 * x * z / 4};
        const Rgb got = fetch(e.irradiance, x, y, z);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(got[c]), expected[c], 3e-3);
    }
}

TEST(environment, has_no_seam_on_any_level_nor_in_irradiance)
{
    const Result<Image> studio = make_builtin_environment("studio");
    ASSERT_TRUE(studio);
    const Environment e = bake(*studio, small_bake());
    const double s = 1e-6;
    for (int level = 0; level <= e.specular.levels; ++level) {
        const CubeMap& cube = level < e.specular.levels ? e.specular : e.irradiance;
        for (int i = 0; i <= 40; ++i) {
            const double along = i / 20.0 - 1.0;
            for (int edge = 0; edge < 12; ++edge) {
                double a[3], b[3];
                const int axis = edge / 4;
                const double p = edge % 2 ? -1.0 : 1.0, q = edge / 2 % 2 ? -1.0 : 1.0;
                a[axis] = b[axis] = along;
                a[(axis + 1) % 3] = p * (1 + s), a[(axis + 2) % 3] = q * (1 - s);
                b[(axis + 1) % 3] = p * (1 - s), b[(axis + 2) % 3] = q * (1 + s);
                const Rgb ca = fetch(cube, a[0], a[1], a[2], level), cb = fetch(cube, b[0], b[1], b[2], level);
                for (std::size_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(ca[c], cb[c], 1e-3f * (ca[c] + cb[c]) + 1e-4f) << "level " << level << " edge " << edge;
            }
        }
    }
}

TEST(environment, bad_pixels_are_repaired_and_reported)
{
    Image image = smooth_equirect(32);
    image.f32()[0] = NAN;
    image.f32()[10] = -5.0f;
    image.f32()[11] = -std::numeric_limits<float>::infinity();
    image.f32()[20] = std::numeric_limits<float>::infinity();
    image.f32()[30] = 77.0f;
    const Environment e = bake(image, small_bake());
    ASSERT_EQ(e.warnings.size(), 3u);
    EXPECT_EQ(e.warnings[0], "1 NaN values of the environment set to 0");
    EXPECT_EQ(e.warnings[1], "2 negative values of the environment set to 0, their surroundings darker by as much");
    EXPECT_EQ(e.warnings[2], "1 infinite values of the environment set to its largest finite value, 77");
    EXPECT_EQ(e.peak_source, 77.0f);
    image.f32()[20] = 1e30f; // no light
    const Environment huge = bake(image, small_bake());
    ASSERT_EQ(huge.warnings.size(), 3u);
    EXPECT_EQ(huge.warnings[2], "1 values of the environment above 1e+12 set to its largest value below that, 77");
    EXPECT_EQ(huge.peak_source, 77.0f);
    for (const std::uint16_t t : e.specular.texels)
        ASSERT_TRUE(std::isfinite(half_to_float(t)));
}

TEST(environment, negative_light_is_taken_from_what_is_around_it)
{
    Image image = smooth_equirect(64);
    const auto at = [&](int x, int y) { return image.f32() + 3 * (static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)); };
    const Equirect before = make_equirect(image);
    for (const auto& [x, y, value] : {std::tuple{18, 10, -4.0f},
                                      {20, 10, 300.0f},
                                      {22, 10, -4.0f},
                                      {20, 13, -9.0f},
                                      {63, 1, -20.0f} /* exceeds the light in its block */})
        std::fill_n(at(x, y), 3, value);
    double sum = 0.0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            sum += (0.2126 * static_cast<double>(at(x, y)[0]) + 0.7152 * static_cast<double>(at(x, y)[1]) +
                    0.0722 * static_cast<double>(at(x, y)[2])) *
                   (std::cos(kPi * y / 32.0) - std::cos(kPi * (y + 1) / 32.0)) / 128.0;
    const Equirect e = make_equirect(image);
    EXPECT_NEAR(mean_luminance(e), sum, 1e-6 * sum);
    EXPECT_GE(*std::min_element(e.rgb.begin(), e.rgb.end()), 0.0f);
    for (int x = 24; x < 32; ++x) // of a block without negative values
        EXPECT_EQ(e.rgb[static_cast<std::size_t>(3 * (10 * 64 + x))], before.rgb[static_cast<std::size_t>(3 * (10 * 64 + x))]);

    Image dark = make_image(8, 4, 3, PixelType::f32);
    std::fill_n(dark.f32(), 96, -1.0f);
    EXPECT_EQ(peak_value(make_equirect(dark)), 0.0f);
}

TEST(environment, a_black_environment_is_black)
{
    const Environment e = bake(make_image(8, 4, 3, PixelType::f32), small_bake());
    EXPECT_EQ(fetch(e.specular, 1, 2, 3, 2.5), (Rgb{0, 0, 0}));
    EXPECT_EQ(fetch(e.irradiance, 1, 2, 3), (Rgb{0, 0, 0}));
    EXPECT_EQ(e.energy_cube, 0.0);
}

TEST(environment, gray_and_eight_bit_images_are_taken)
{
    Image image = make_image(16, 8, 1, PixelType::u8);
    std::fill(image.bytes.begin(), image.bytes.end(), static_cast<std::byte>(188)); // 0.503 linear
    const Environment e = bake(image, small_bake());
    const Rgb c = fetch(e.specular, 0, 1, 0);
    EXPECT_NEAR(c[0], 0.503f, 1e-3f);
    EXPECT_EQ(c[0], c[2]);
    EXPECT_EQ(e.warnings.size(), 1u);
}

TEST(environment, bad_options_and_images_are_errors)
{
    const Image image = smooth_equirect(16);
    const Jobs jobs(1);
    const auto code = [&](auto change) {
        EnvironmentOptions o = small_bake();
        change(o);
        const Result<Environment> e = bake_environment(image, "x", o, jobs);
        return e ? ExitCode::ok : e.error().code;
    };
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.cube_size = 48; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.cube_size = 0; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.levels = 7; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.samples = 0; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.extracted_lights = 9; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.exposure_ev = NAN; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.rotation_deg = INFINITY; }), ExitCode::usage);
    EXPECT_EQ(code([](EnvironmentOptions& o) { o.levels = 6; }), ExitCode::ok);
    const Result<Environment> empty = bake_environment(Image{}, "x", small_bake(), jobs);
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().code, ExitCode::bad_input);
    const Result<Environment> missing = load_environment("/nonexistent/a.hdr", small_bake(), Limits{}, jobs);
    EXPECT_FALSE(missing);
}

TEST(environment, thread_count_does_not_change_a_bit)
{
    const Image image = smooth_equirect(64);
    const Environment one = bake(image, small_bake(), 1);
    for (const int threads : {2, 3}) {
        const Environment e = bake(image, small_bake(), threads);
        EXPECT_TRUE(std::equal(one.specular.texels.begin(), one.specular.texels.end(), e.specular.texels.begin()));
        EXPECT_TRUE(std::equal(one.irradiance.texels.begin(), one.irradiance.texels.end(), e.irradiance.texels.begin()));
        EXPECT_EQ(one.energy_cube, e.energy_cube);
    }
}

// Users keep baked environments for years. If the bits change under an unchanged version, their caches would return stale data.
TEST(environment, a_bake_of_other_bits_raises_the_version)
{
    EnvironmentOptions options;
    options.cube_size = 32, options.samples = 32, options.use_cache = false;
    const Result<Environment> e = load_environment("builtin:studio", options, Limits{}, Jobs(2));
    ASSERT_TRUE(e);
    const std::uint64_t specular = hash_bytes(e->specular.texels.data(), e->specular.texels.size() * 2);
    const std::uint64_t both = hash_bytes(e->irradiance.texels.data(), e->irradiance.texels.size() * 2, specular);
    EXPECT_EQ(kBakeVersion, 5u);
    EXPECT_EQ(both, 0x94871c52210d74f2u) << std::hex << both << ": raise kBakeVersion, then copy this hash";
}

} // namespace
} // namespace burnish
