#include "shading/bake/environment/image_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/image/colour.h"
#include "shading/bake/environment/equirect.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

// Orientation of the faces from inside, with upright images: the directions ahead and up.
struct Look {
    glm::dvec3 ahead, up;
};
const Look kLooks[6] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, -1}},
                        {{0, -1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};

// Returns a 16-bit sRGB light. value: linear, [0,1], of a unit direction and a channel. divisor: stored in a fourth channel; 0: three
// channels.
ImageLight light_of(int size, const std::function<double(glm::dvec3, int)>& value, double divisor = 0.0)
{
    ImageLight light;
    light.size = size;
    for (const Look& look : kLooks) {
        const glm::dvec3 right = glm::cross(look.ahead, look.up);
        Image face = make_image(size, size, divisor > 0.0 ? 4 : 3, PixelType::u16);
        auto* to = reinterpret_cast<std::uint16_t*>(face.bytes.data());
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const double u = (2 * x + 1.0) / size - 1.0, v = (2 * y + 1.0) / size - 1.0;
                const glm::dvec3 d = glm::normalize(look.ahead + u * right - v * look.up);
                const auto code = [](double t) { return static_cast<std::uint16_t>(std::lround(65535.0 * t)); };
                for (int c = 0; c < 3; ++c) {
                    const double linear = value(d, c) * (divisor > 0.0 ? divisor : 1.0);
                    *to++ = code(linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
                }
                if (divisor > 0.0)
                    *to++ = code(divisor);
            }
        light.faces.push_back(std::move(face));
    }
    return light;
}

double smooth(glm::dvec3 d, int c)
{
    return 0.4 + (c == 0 ? 0.3 * d.x + 0.1 * d.y * d.z : c == 1 ? 0.25 * d.y - 0.1 * d.x : 0.3 * d.z * (0.5 + 0.4 * d.x));
}

// Returns the largest difference from `value` in any channel.
double worst(const Image& sky, const std::function<double(glm::dvec3, int)>& value)
{
    double most = 0.0;
    const Image wanted = equirect_of(sky.width, [&](double x, double y, double z, float* rgb) {
        for (int c = 0; c < 3; ++c)
            rgb[c] = static_cast<float>(value({x, y, z}, c));
    });
    for (std::size_t i = 0; i < wanted.bytes.size() / sizeof(float); ++i)
        most = std::max(most, static_cast<double>(std::fabs(sky.f32()[i] - wanted.f32()[i])));
    return most;
}

TEST(image_light, every_direction_shows_what_its_face_holds)
{
    const Image sky = sky_of(light_of(64, smooth), Jobs(2));
    ASSERT_EQ(sky.width, 256);
    ASSERT_EQ(sky.height, 128);
    EXPECT_LT(worst(sky, smooth), 0.012); // half a texel of 1/32, times the slope
}

TEST(image_light, is_turned_by_its_rotation_and_multiplied_by_its_intensity)
{
    ImageLight light = light_of(64, smooth);
    light.world_from_cube = glm::dmat3(0, 0, -1, 0, 1, 0, 1, 0, 0); // a quarter turn about +Y: +x goes to -z, +z to +x
    light.intensity = 2.0;
    EXPECT_LT(worst(sky_of(light, Jobs(1)), [](glm::dvec3 d, int c) { return 2.0 * smooth({-d.z, d.y, d.x}, c); }), 0.024);
}

TEST(image_light, a_fourth_channel_divides_linear_values)
{
    const auto bright = [](glm::dvec3 d, int c) { return 8.0 * smooth(d, c); };
    EXPECT_LT(worst(sky_of(light_of(64, bright, 0.1), Jobs(2)), bright), 0.1);
    ImageLight none = light_of(4, smooth, 0.5);
    for (Image& face : none.faces)
        for (std::size_t i = 0; i < 16; ++i)
            reinterpret_cast<std::uint16_t*>(face.bytes.data())[i * 4 + 3] = 0;
    EXPECT_EQ(worst(sky_of(none, Jobs(1)), [](glm::dvec3, int) { return 0.0; }), 0.0);
}

TEST(image_light, keeps_the_light_of_the_cube)
{
    // one bright texel a face, each at another place
    const int n = 16;
    double sum = 0.0;
    const ImageLight light = light_of(n, [&](glm::dvec3 d, int) {
        const glm::dvec3 a = glm::abs(d);
        const double most = std::max({a.x, a.y, a.z}), u = (a.x == most ? d.y : d.x) / most, v = (a.z == most ? d.y : d.z) / most;
        return u > 0.1 && u < 0.25 && v > 0.4 && v < 0.5 ? 1.0 : 0.01;
    });
    double all = 0.0;
    for (const Image& face : light.faces)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const double u = (2 * x + 1.0) / n - 1.0, v = (2 * y + 1.0) / n - 1.0, weight = std::pow(1.0 + u * u + v * v, -1.5);
                const std::size_t i = static_cast<std::size_t>(y * n + x) * 3;
                sum +=
                    weight * static_cast<double>(srgb_to_linear(reinterpret_cast<const std::uint16_t*>(face.bytes.data())[i] / 65535.0f));
                all += weight;
            }
    EXPECT_NEAR(mean_luminance(make_equirect(sky_of(light, Jobs(2)))), sum / all, 0.005 * sum / all);
}

TEST(image_light, does_not_depend_on_threads)
{
    const ImageLight light = light_of(16, smooth);
    EXPECT_EQ(sky_of(light, Jobs(1)).bytes, sky_of(light, Jobs(3)).bytes);
}

} // namespace
} // namespace burnish
