#include "raster/frame/colours.h"

#include <algorithm>
#include <cmath>

#include "core/image/colour.h"
#include "core/scene/heights.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/anisotropy.h"

namespace burnish {

namespace {

const Texture& texture_of(const Scene& scene, const TextureRef& ref)
{
    return scene.textures[static_cast<std::size_t>(ref.texture)];
}

// Of the normal map alone, whatever the material's other maps.
MipSource normals_of(const Scene& scene, const Material& m)
{
    const Texture& texture = texture_of(scene, m.normal_tex);
    MipMaps maps;
    maps.normal = &scene.images[static_cast<std::size_t>(texture.image)];
    maps.wrap_s = texture.wrap_s, maps.wrap_t = texture.wrap_t, maps.nearest = texture.nearest;
    maps.normal_scale = m.normal_scale;
    return MipSource(maps);
}

} // namespace

Image linear_map(const Image& image, const Grid& grid, bool srgb, std::size_t first, int channels, const float* factor)
{
    Image to = make_image(grid.width, grid.height, channels, PixelType::f32);
    float* out = to.f32();
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x)
            for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
                *out++ = factor[c] * on_grid(image, grid, x, y, [&](std::size_t texel) {
                             const float value = texel_channel(image, texel, first + c);
                             const float finite = std::isfinite(value) ? value : 0.0f;
                             return srgb && c < 3 && image.type != PixelType::f32 ? srgb_to_linear(finite) : finite;
                         });
    return to;
}

Image facing_of(const MipSource& source)
{
    Image to = make_image(source.width(), source.height(), 1, PixelType::f32);
    std::vector<MipPoint> row(static_cast<std::size_t>(source.width()));
    for (int y = 0; y < source.height(); ++y) {
        source.row(y, row.data());
        for (std::size_t x = 0; x < row.size(); ++x)
            to.f32()[static_cast<std::size_t>(y) * row.size() + x] = std::max(row[x].n.z * row[x].n.z, 1e-4f);
    }
    return to;
}

bool is_coupled(const Scene& scene, const Material& m, const TextureRef& colours)
{
    return m.mip_coupled && m.normal_tex.used() && colours.used() && lie_alike(scene, m.normal_tex, colours);
}

std::string why_uncoupled(const Scene& scene, const Material& m)
{
    if (!m.mip_coupled || !m.base_color_tex.used() || !m.normal_tex.used() || is_coupled(scene, m, m.base_color_tex))
        return "";
    return "has base colours that lie otherwise than its normals: they are not coupled";
}

TexturePyramid colour_pyramid(const Scene& scene, const Material& m, const Texture& texture, TextureEncoding encoding, bool coupled,
                              bool kaiser)
{
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    const Grid grid = {image.width, image.height, texture.wrap_s, texture.wrap_t, texture.nearest};
    constexpr float kOnes[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const int channels = image.channels == 4 ? 4 : 3;
    const Image linear = linear_map(image, grid, encoding == TextureEncoding::srgb, 0, channels, kOnes);
    Image facing;
    if (coupled)
        facing = linear_map(facing_of(normals_of(scene, m)), grid, false, 0, 1, kOnes);
    const std::vector<Image> levels = colour_levels(
        linear, {kaiser ? ColourKernel::kaiser : ColourKernel::box, texture.wrap_s, texture.wrap_t, coupled ? &facing : nullptr});
    return make_texture_pyramid(image.width, image.height, texture, encoding, [&](int level, int width, int y, float* rgba) {
        const std::size_t held = static_cast<std::size_t>(channels);
        const float* from =
            levels[static_cast<std::size_t>(level)].f32() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * held;
        for (int x = 0; x < width; ++x, from += held, rgba += 4) {
            rgba[3] = 1.0f;
            std::copy_n(from, held, rgba);
        }
    });
}

} // namespace burnish
