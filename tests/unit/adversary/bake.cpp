// Fetches: the place and texel on a cube, a texture's level and taps, directional albedo.
#include <cmath>

#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/texture.h"
#include "tests/unit/adversary/domains.h"

namespace burnish::test {
namespace {

constexpr int kSide = 16, kLevels = 5;

TexelView cube()
{
    static const CubeMap made = [] {
        CubeMap out = make_cube_map(kSide, kLevels, 1.0f);
        Random random(5);
        for (int l = 0; l < kLevels; ++l) {
            std::vector<float> rgb(cube_texels(kSide >> l) * 3);
            for (float& v : rgb)
                v = static_cast<float>(random.next());
            store_cube_level(out, l, rgb.data(), Jobs(1));
        }
        return out;
    }();
    return {.texels = made.texels.data(), .size = made.size, .levels = made.levels};
}

TexelView texture()
{
    static const TexturePyramid made = [] {
        Image image = make_image(kSide, kSide, 4, PixelType::u8);
        Random random(7);
        for (std::byte& b : image.bytes)
            b = static_cast<std::byte>(random.next() * 256.0);
        return make_texture_pyramid(image, Texture{}, TextureEncoding::linear);
    }();
    return {.texels = made.texels.data(),
            .levels = made.levels,
            .offset = made.offset,
            .level_width = made.level_width,
            .level_height = made.level_height,
            .wrap_s = static_cast<int>(made.wrap_s),
            .wrap_t = static_cast<int>(made.wrap_t),
            .nearest = made.nearest,
            .max_taps = 8};
}

TexelView albedos()
{
    static const DfgTable made = bake_dfg(kSide, 64, Jobs(1));
    return {.pairs = made.pairs.data(), .size = made.size};
}

std::vector<double> directions(const Domain&, const double* u)
{
    std::vector<double> a;
    append(a, any_direction(u[0], u[1]));
    return a;
}

std::vector<double> fetches(const Domain& d, const double* u)
{
    std::vector<double> a = directions(d, u);
    a.push_back(straight(u[2], 0.0, kLevels - 1));
    return a;
}

// Returns texture coordinate derivatives per pixel, 1e-4 to 10 texels long, in any direction.
std::vector<double> footprints(const Domain&, const double* u)
{
    std::vector<double> a = {u[0], u[1]};
    for (const double* v : {u + 2, u + 4}) {
        const double length = by_factors(v[0], 1e-4, 10.0) / kSide;
        a.push_back(length * std::cos(6.2831853 * v[1])), a.push_back(length * std::sin(6.2831853 * v[1]));
    }
    return a;
}

} // namespace

const std::vector<Domain>& domains()
{
    const std::vector<Judged> albedo = {{"albedo", 0, 2, Unit::whole}};
    static const std::vector<Domain> list = {
        {"cube_place", 2, directions, {{"place", 1, 2, Unit::whole}}, 0},
        {"cube", 3, fetches, {{"colour", 0, 3, Unit::whole}}, -1, cube},
        {"cube_level", 2, directions, {{"colour", 0, 3, Unit::whole}}, -1, cube},
        {"footprint", 6, footprints, {{"level", 0, 1, Unit::whole}}, 1, texture},
        {"texture", 6, footprints, {{"colour", 0, 4, Unit::whole}}, -1, texture},
        {"dfg_fit", 2, ranges, albedo, -1, nullptr, {{0.0, 1.0}, {0.0, 1.0}}},
        {"dfg_lookup", 2, ranges, albedo, -1, albedos, {{0.0, 1.0}, {0.0, 1.0}}},
    };
    return list;
}

} // namespace burnish::test
