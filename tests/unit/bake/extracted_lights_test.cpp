// Extracted lights: the parts of an image that become extracted lights, and energy conservation where they leave the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/scene/builtin/builtin.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/equirect.h"
#include "shading/bake/environment/extracted_lights.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Lamp {
    double azimuth_deg, elevation_deg, radius_deg, radiance;
};
Direction towards(const Lamp& l)
{
    const double a = l.azimuth_deg * kDegree, e = l.elevation_deg * kDegree;
    return {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
}

// Returns uniform discs with soft edges on a smooth sky, one colour each.
Image sky_with(const std::vector<Lamp>& lamps, double sky = 0.3, int width = 1024)
{
    return equirect_of(width, [&](double x, double y, double z, float* rgb) {
        const double smooth = sky * (1.0 + 0.5 * y + 0.2 * x);
        rgb[0] = static_cast<float>(smooth * 0.5), rgb[1] = static_cast<float>(smooth * 0.8), rgb[2] = static_cast<float>(smooth);
        for (const Lamp& l : lamps) {
            const Direction d = towards(l);
            const double angle = std::acos(std::min(x * d.x + y * d.y + z * d.z, 1.0)) / kDegree;
            const double t = std::clamp((l.radius_deg * 1.15 - angle) / (0.3 * l.radius_deg), 0.0, 1.0);
            const double more = l.radiance * t * t * (3.0 - 2.0 * t);
            rgb[0] += static_cast<float>(more), rgb[1] += static_cast<float>(0.9 * more), rgb[2] += static_cast<float>(0.7 * more);
        }
    });
}

std::vector<double> light_of(const Equirect& e) // by channel, radiance times solid angle
{
    std::vector<double> sum(3, 0.0);
    for (int y = 0; y < e.height; ++y) {
        const double pi = std::numbers::pi, band = std::cos(pi * y / e.height) - std::cos(pi * (y + 1) / e.height);
        for (int x = 0; x < e.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += static_cast<double>(e.rgb[3 * static_cast<std::size_t>(y * e.width + x) + c]) * band * 2.0 * pi / e.width;
    }
    return sum;
}

double degrees_between(const float* a, const Direction& b)
{
    const double x = static_cast<double>(a[0]) - b.x, y = static_cast<double>(a[1]) - b.y, z = static_cast<double>(a[2]) - b.z;
    return 2.0 * std::asin(0.5 * std::sqrt(x * x + y * y + z * z)) / kDegree;
}

struct Taken {
    Equirect before, after;
    std::vector<ExtractedLight> lights;
    std::vector<SkyCap> changed;
};
Taken take(const Image& image, int most = 8)
{
    Taken t;
    t.before = t.after = make_equirect(image);
    t.lights = extract_lights(t.after, most, t.changed);
    return t;
}

// The extracted lights and the remaining image add up to the source in every channel.
void expect_nothing_lost(const Taken& t)
{
    std::vector<double> sum = light_of(t.after);
    const std::vector<double> source = light_of(t.before);
    for (std::size_t c = 0; c < 3; ++c) {
        for (const ExtractedLight& k : t.lights)
            sum[c] += static_cast<double>(k.irradiance[c]);
        EXPECT_NEAR(sum[c], source[c], 1e-5 * source[c]) << "channel " << c;
    }
}

TEST(extracted_lights, of_the_sky_are_its_sun_and_the_studio_has_none)
{
    const Taken sky = take(*make_builtin_environment("sky"));
    ASSERT_EQ(sky.lights.size(), 1u);
    const ExtractedLight& sun = sky.lights[0];
    const double length = std::sqrt(0.55 * 0.55 + 0.62 * 0.62 + 0.56 * 0.56);
    EXPECT_LT(degrees_between(sun.direction, {-0.55 / length, 0.62 / length, 0.56 / length}), 0.03);
    EXPECT_NEAR(static_cast<double>(sun.angular_radius), 1.0 * kDegree, 0.06 * kDegree);
    EXPECT_GT(sun.share, 0.6f);
    expect_nothing_lost(sky);
    EXPECT_LT(peak_value(sky.after), 20.0f); // the aureole; the sun has 9000
    const Taken studio = take(*make_builtin_environment("studio"));
    EXPECT_TRUE(studio.lights.empty());
    EXPECT_EQ(studio.before.rgb, studio.after.rgb);
}

// Tests all positions: at the poles, where rows are short, and on the image's seam.
TEST(extracted_lights, are_found_anywhere_with_their_size_and_radiance)
{
    for (const double elevation : {-90.0, -40.0, 2.0, 60.0, 88.0, 90.0})
        for (const double azimuth : {0.0, 180.0, 77.0}) {
            const Lamp lamp = {azimuth, elevation, 1.5, 3000.0};
            const Taken t = take(sky_with({lamp}));
            ASSERT_EQ(t.lights.size(), 1u) << elevation << " " << azimuth;
            const ExtractedLight& k = t.lights[0];
            EXPECT_LT(degrees_between(k.direction, towards(lamp)), 0.05) << elevation << " " << azimuth;
            EXPECT_NEAR(static_cast<double>(k.angular_radius) / kDegree, 1.5, 0.12) << elevation << " " << azimuth;
            const double radius = static_cast<double>(k.angular_radius), solid_angle = std::numbers::pi * radius * radius;
            EXPECT_NEAR(static_cast<double>(k.irradiance[0]) / solid_angle, 3000.0, 0.12 * 3000.0) << elevation << " " << azimuth;
            expect_nothing_lost(t);
            EXPECT_LT(peak_value(t.after), 0.6f) << "the hole shows";
        }
}

TEST(extracted_lights, have_the_shape_of_their_region)
{
    // a lamp three times as wide as high
    const Image image = equirect_of(2048, [](double x, double y, double z, float* rgb) {
        const double a = std::atan2(z, x) / kDegree / 2.0, e = std::asin(y) / kDegree / 0.66;
        rgb[0] = rgb[1] = rgb[2] = a * a + e * e < 1.0 ? 500.0f : 0.2f;
    });
    const Taken t = take(image);
    ASSERT_EQ(t.lights.size(), 1u);
    const ExtractedLight& k = t.lights[0];
    const auto length = [](const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
    EXPECT_NEAR(static_cast<double>(length(k.axis_u)) / kDegree, 2.0, 0.2);
    EXPECT_NEAR(static_cast<double>(length(k.axis_v)) / kDegree, 0.66, 0.15);
    EXPECT_GT(std::fabs(k.axis_u[2]), 10.0f * std::fabs(k.axis_u[1])); // lies along the horizon
    expect_nothing_lost(t);
}

TEST(extracted_lights, are_the_strongest_of_many_and_no_more_than_asked_for)
{
    std::vector<Lamp> lamps;
    for (int i = 0; i < 12; ++i)
        lamps.push_back({30.0 * i, 20.0, 1.2, 200.0 + 20.0 * i});
    for (const int most : {0, 1, 5, 8}) {
        const Taken t = take(sky_with(lamps), most);
        ASSERT_EQ(t.lights.size(), static_cast<std::size_t>(most));
        for (int i = 0; i < most; ++i)
            EXPECT_LT(degrees_between(t.lights[static_cast<std::size_t>(i)].direction, towards(lamps[static_cast<std::size_t>(11 - i)])),
                      0.1);
        expect_nothing_lost(t);
    }
}

TEST(extracted_lights, of_neighbours_are_two)
{
    const std::vector<Lamp> suns = {{40.0, 30.0, 1.0, 4000.0}, {48.0, 30.0, 1.0, 2500.0}};
    const Taken t = take(sky_with(suns));
    ASSERT_EQ(t.lights.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_LT(degrees_between(t.lights[i].direction, towards(suns[i])), 0.1);
    expect_nothing_lost(t);
}

// Large bright surfaces, faint lights, gradients and lines of light stay in the image.
TEST(extracted_lights, are_not_windows_nor_stars_nor_tubes)
{
    const auto none = [](const Image& image) {
        const Taken t = take(image);
        EXPECT_EQ(t.before.rgb, t.after.rgb);
        return t.lights.empty();
    };
    EXPECT_TRUE(none(sky_with({{10.0, 10.0, 12.0, 100.0}})));                    // a window
    EXPECT_TRUE(none(sky_with({{10.0, 10.0, 0.5, 5.0}})));                       // a star
    EXPECT_TRUE(none(smooth_equirect(256)));                                     // a gradient
    EXPECT_TRUE(none(equirect_of(512, [](double, double y, double, float* rgb) { // a ring of light
        rgb[0] = rgb[1] = rgb[2] = std::fabs(y) < 0.01 ? 100.0f : 0.1f;
    })));
}

// The remaining cube equals a full resampling, although only the texels near the lights are resampled.
TEST(extracted_lights, leave_a_cube_that_is_sampled_again_around_them)
{
    const Jobs jobs(2);
    const std::vector<Lamp> places = {
        {0.0, -90.0, 2.0, 3000.0}, {45.0, 35.3, 2.0, 3000.0}, {180.0, 0.0, 2.0, 3000.0}, {10.0, 88.0, 2.0, 3000.0}};
    for (const Lamp& lamp : places)
        for (const int size : {64, 256}) {
            const Taken t = take(sky_with({lamp, {lamp.azimuth_deg + 100.0, 20.0, 2.0, 3000.0}}, 0.3, 256));
            ASSERT_EQ(t.lights.size(), 2u);
            CubeLevel cube = sample_equirect(t.before, size, jobs);
            sample_equirect_again(cube, t.after, t.changed, jobs);
            EXPECT_EQ(cube.rgb, sample_equirect(t.after, size, jobs).rgb) << lamp.elevation_deg << " " << size;
            Equirect black = t.after;
            std::fill(black.rgb.begin(), black.rgb.end(), 0.0f);
            sample_equirect_again(cube, black, t.changed, jobs);
            const auto sampled = std::count(cube.rgb.begin(), cube.rgb.end(), 0.0f);
            EXPECT_LT(static_cast<double>(sampled), 0.25 * static_cast<double>(cube.rgb.size())) << lamp.elevation_deg << " " << size;
        }
}

TEST(extracted_lights, need_no_particular_picture)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 7}, {3, 2}, {64, 32}})
        for (const float even : {0.0f, 1.0f}) {
            Image image = make_image(width, height, 3, PixelType::f32);
            std::fill_n(image.f32(), width * height * 3, even);
            Taken t = take(image);
            EXPECT_TRUE(t.lights.empty()) << width << "x" << height;
            EXPECT_EQ(t.before.rgb, t.after.rgb);
            image.f32()[0] = image.f32()[1] = image.f32()[2] = 1e9f;
            t = take(image);
            expect_nothing_lost(t);
        }
    Image image = make_image(64, 32, 3, PixelType::f32); // one bright texel and nothing else
    image.f32()[3 * (64 * 10 + 20) + 1] = 5.0f;
    const Taken t = take(image);
    expect_nothing_lost(t);
}

// The whole environment keeps its bits, and so does everything where no light is extracted.
TEST(extracted_lights, leave_the_whole_picture_as_it_is)
{
    const auto baked = [](const Image& image, int most) {
        EnvironmentOptions o = small_bake();
        o.extracted_lights = most, o.cube_size = 64;
        return *bake_environment(image, "test", o, Jobs(2));
    };
    const auto same = [](const CubeMap& a, const CubeMap& b, std::size_t texels) {
        return a.scale == b.scale &&
               std::equal(a.texels.begin(), a.texels.begin() + static_cast<std::ptrdiff_t>(4 * texels), b.texels.begin());
    };
    const Image sky = sky_with({{40.0, 30.0, 2.0, 4000.0}}, 0.3, 512);
    const Environment off = baked(sky, 0), on = baked(sky, 8);
    ASSERT_EQ(on.extracted_lights.size(), 1u);
    EXPECT_TRUE(off.extracted_lights.empty());
    EXPECT_TRUE(same(off.picture(), on.picture(), off.specular.level_texels(0)));
    EXPECT_EQ(on.energy_cube, off.energy_cube);
    const Environment smooth = baked(smooth_equirect(256), 8), plain = baked(smooth_equirect(256), 0);
    EXPECT_TRUE(same(smooth.specular, plain.specular, smooth.specular.texels.size() / 4));
    EXPECT_EQ(&smooth.picture(), &smooth.specular);
    // the cube's brightest texel lies at the light
    const CubeMap& whole = on.picture();
    float brightest = 0.0f;
    Direction at = {};
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < 64 * 64; ++i)
            if (const float v = cube_texel(whole, 0, face, i % 64, i / 64, 0); v > brightest) {
                brightest = v;
                at = cube_direction(face, (i % 64 + 0.5) / 32.0 - 1.0, (i / 64 + 0.5) / 32.0 - 1.0);
            }
    const double length = std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
    EXPECT_LT(degrees_between(on.extracted_lights[0].direction, {at.x / length, at.y / length, at.z / length}), 2.0);
}

} // namespace
} // namespace burnish
