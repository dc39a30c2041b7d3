// Quaternion maps, component by component, at n' = (.48, -.6, .64), derived by hand. Images hold floats.
#include <gtest/gtest.h>

#include <cstdint>

#include "core/scene/surface_maps.h"

namespace burnish {
namespace {

constexpr double kNormal[3] = {0.48, -0.6, 0.64}, kTurn[3] = {0.90553851, -0.33129458, -0.26503566};

Image texel(double r, double g, double b)
{
    Image image = make_image(1, 1, 3, PixelType::f32);
    image.f32()[0] = static_cast<float>(r), image.f32()[1] = static_cast<float>(g), image.f32()[2] = static_cast<float>(b);
    return image;
}

void expect_part_of_turn(std::size_t part)
{
    const Image normal = texel(0.5 + 0.5 * kNormal[0], 0.5 + 0.5 * kNormal[1], 0.5 + 0.5 * kNormal[2]);
    const SurfaceMap map = quaternions_of_normals(normal, PixelType::f32);
    EXPECT_NEAR(static_cast<double>(map.image.f32()[part]), kTurn[part], 1e-6);
    EXPECT_EQ(map.repaired, 0u);
}
TEST(surface_maps, quaternions_are_red_half_the_angle)
{
    expect_part_of_turn(0);
}
TEST(surface_maps, quaternions_are_green_as_y_says)
{
    expect_part_of_turn(1);
}
TEST(surface_maps, quaternions_are_blue_against_x)
{
    expect_part_of_turn(2);
}

void expect_part_of_normal(std::size_t part)
{
    const SurfaceMap map = normals_of_quaternions(texel(kTurn[0], kTurn[1], kTurn[2]));
    const double code = reinterpret_cast<const std::uint16_t*>(map.image.bytes.data())[part];
    EXPECT_NEAR(2.0 * code / 65535.0 - 1.0, kNormal[part], 3e-5);
}
TEST(surface_maps, normals_of_quaternions_lean_along_x)
{
    expect_part_of_normal(0);
}
TEST(surface_maps, normals_of_quaternions_lean_along_y)
{
    expect_part_of_normal(1);
}
TEST(surface_maps, normals_of_quaternions_rise)
{
    expect_part_of_normal(2);
}

} // namespace
} // namespace burnish
