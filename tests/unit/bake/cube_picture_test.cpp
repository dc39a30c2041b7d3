// OpenEXR's cubes against the format's definition: the direction of every face texel.
#include "shading/bake/environment/cube_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "shading/bake/environment/equirect.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish::cube_pictures {
namespace {

struct CubeTexel {
    glm::dvec3 direction; // in OpenEXR's axes, not unit
    int column, row;      // in the image
};

// Returns the texel at (i, j) of a face, in the format's numbering; n: texels along an edge.
CubeTexel cube_texel(int face, int i, int j, int n)
{
    const double s = 2.0 * i / (n - 1) - 1.0, t = 2.0 * j / (n - 1) - 1.0;
    const int last = n - 1, top = face * n;
    switch (face) {
    case 0:
        return {{1, s, t}, j, top + last - i};
    case 1:
        return {{-1, s, t}, last - j, top + last - i};
    case 2:
        return {{s, 1, t}, i, top + last - j};
    case 3:
        return {{s, -1, t}, i, top + j};
    case 4:
        return {{s, t, 1}, last - i, top + last - j};
    default:
        return {{s, t, -1}, i, top + last - j};
    }
}

// radiance: a function of our unit direction. Our +X is OpenEXR's +Z; both point to the centre of an equirectangular image.
template <class Radiance> Image cube_of(int size, const Radiance& radiance)
{
    Image faces = make_image(size, 6 * size, 3, PixelType::f32);
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < size; ++j) {
                const CubeTexel texel = cube_texel(face, i, j, size);
                const glm::dvec3 d = glm::normalize(texel.direction);
                radiance(d.z, d.y, -d.x, faces.f32() + (texel.row * size + texel.column) * 3);
            }
    return faces;
}

void coloured(double x, double y, double z, float* rgb)
{
    rgb[0] = static_cast<float>(1.5 + x), rgb[1] = static_cast<float>(1.5 + y + 0.3 * x * z), rgb[2] = static_cast<float>(1.5 + z);
}

TEST(cube_picture, every_direction_shows_what_its_face_holds)
{
    const Image sky = sky_of_cube_picture(cube_of(64, coloured), Jobs(2)), wanted = equirect_of(256, coloured);
    ASSERT_EQ(sky.width, 256);
    ASSERT_EQ(sky.height, 128);
    ASSERT_EQ(sky.channels, 3);
    float worst = 0.0f;
    for (std::size_t i = 0; i < sky.bytes.size() / 4; ++i)
        worst = std::max(worst, std::fabs(sky.f32()[i] - wanted.f32()[i]));
    EXPECT_LT(worst, 2e-3f);
}

TEST(cube_picture, its_bits_do_not_depend_on_threads)
{
    const Image faces = cube_of(16, coloured);
    EXPECT_EQ(sky_of_cube_picture(faces, Jobs(1)).bytes, sky_of_cube_picture(faces, Jobs(3)).bytes);
}

TEST(cube_picture, a_face_of_one_texel_and_grey_are_read)
{
    Image faces = make_image(1, 6, 1, PixelType::f32);
    for (int face = 0; face < 6; ++face)
        faces.f32()[face] = static_cast<float>(face);
    const Image sky = sky_of_cube_picture(faces, Jobs(1));
    ASSERT_EQ(sky.width, 4);
    ASSERT_EQ(sky.channels, 1);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_TRUE(sky.f32()[i] >= 0.0f && sky.f32()[i] <= 5.0f);
}

TEST(cube_picture, other_shapes_and_large_faces_are_faults)
{
    EXPECT_EQ(cube_picture_fault(make_image(4, 24, 3, PixelType::f32), 128), "");
    EXPECT_NE(cube_picture_fault(make_image(4, 24, 3, PixelType::f32), 127).find("Limits::env_pixels"), std::string::npos);
    EXPECT_NE(cube_picture_fault(make_image(4, 25, 3, PixelType::f32), 1000).find("4 x 25"), std::string::npos);
    EXPECT_NE(cube_picture_fault(make_image(24, 4, 3, PixelType::f32), 1000).find("24 x 4"), std::string::npos);
}

TEST(equirect_shape, pictures_that_are_not_twice_as_wide_as_high_are_said_with_their_size)
{
    const auto warning = [](int width, int height) {
        Image image = make_image(width, height, 3, PixelType::f32);
        image.f32()[0] = 1.0f;
        return equirect_shape_warning(image);
    };
    for (const std::array<int, 2>& size : {std::array{64, 32}, {1024, 512}, {1001, 500}, {2, 1}})
        EXPECT_EQ(warning(size[0], size[1]), "") << size[0];
    EXPECT_NE(warning(32, 32).find("32 x 32 pixels are not twice as wide as high"), std::string::npos);
    EXPECT_NE(warning(64, 48).find("cross"), std::string::npos);
    EXPECT_NE(warning(48, 64).find("cross"), std::string::npos);
    EXPECT_NE(warning(96, 16).find("row"), std::string::npos);
    EXPECT_NE(warning(16, 96).find("column"), std::string::npos);
    EXPECT_EQ(warning(70, 32).find("looks like"), std::string::npos);
    EXPECT_NE(warning(70, 32), "");
}

TEST(equirect_shape, a_picture_of_one_colour_has_no_shape)
{
    EXPECT_EQ(equirect_shape_warning(make_image(5, 5, 3, PixelType::f32)), "");
    EXPECT_EQ(equirect_shape_warning(make_image(1, 1, 3, PixelType::u8)), "");
}

} // namespace
} // namespace burnish::cube_pictures
