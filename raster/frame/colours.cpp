#include "raster/frame/colours.h"

#include <algorithm>
#include <cmath>

#include "core/image/colour.h"
#include "core/scene/height_map.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/map_levels.h"

namespace burnish {

namespace {

const Texture& texture_of(const Scene& scene, const TextureRef& ref)
{
    return scene.textures[static_cast<std::size_t>(ref.texture)];
}

} // namespace

MipSource normals_of(const Scene& scene, const Material& m)
{
    const Texture& texture = texture_of(scene, m.normal_tex);
    MipMaps maps;
    maps.normal = &scene.images[static_cast<std::size_t>(texture.image)];
    maps.wrap_s = texture.wrap_s, maps.wrap_t = texture.wrap_t, maps.nearest = texture.nearest;
    maps.normal_scale = m.normal_scale;
    return MipSource(maps);
}

const Image& map_image(const Scene& scene, const TextureRef& ref)
{
    return scene.images[static_cast<std::size_t>(texture_of(scene, ref).image)];
}

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

Image facing_of(const MipSource& source, const Jobs& jobs)
{
    Image to = make_image(source.width(), source.height(), 1, PixelType::f32);
    const std::size_t width = static_cast<std::size_t>(source.width());
    jobs.parallel_for(static_cast<std::size_t>(source.height()), [&](std::size_t y, int) {
        std::vector<MipPoint> row(width);
        source.row(static_cast<int>(y), row.data());
        for (std::size_t x = 0; x < width; ++x)
            to.f32()[y * width + x] = std::max(row[x].n.z * row[x].n.z, 1e-4f);
    });
    return to;
}

bool is_coupled(const Scene& scene, const Material& m, const MaterialMips& mips, const TextureRef& colours)
{
    return mips.coupled && m.normal_tex.used() && colours.used() && lie_alike(scene, m.normal_tex, colours);
}

std::string why_uncoupled(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    if (!mips.coupled || !m.base_color_tex.used() || !m.normal_tex.used() || is_coupled(scene, m, mips, m.base_color_tex))
        return "";
    return "has base colours that lie otherwise than its normals: they are not coupled";
}

std::vector<UsedMap> used_maps(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    std::vector<UsedMap> maps;
    const ColourKernel kernel = mips.kaiser ? ColourKernel::kaiser : ColourKernel::box;
    for (const auto& [part, ref] :
         {std::pair(MapPart::base_color, &m.base_color_tex), {MapPart::metallic_roughness, &m.metallic_roughness_tex}})
        if (ref->used())
            maps.push_back({part, ref, kernel, is_coupled(scene, m, mips, *ref)});
    if (m.has_height_map && m.normal_tex.used())
        maps.push_back({MapPart::height, &m.normal_tex, ColourKernel::box, false});
    return maps;
}

const char* name_of(MapPart part)
{
    return part == MapPart::base_color ? "base colours" : part == MapPart::height ? "heights" : "metalness";
}

MapId map_id(const Scene& scene, const Material& m, const UsedMap& map, const Jobs& jobs)
{
    return {map.part, map.kernel, map_hash(map_image(scene, *map.ref), texture_of(scene, *map.ref), map.part),
            map.coupled ? normals_of(scene, m).hash(jobs) : 0};
}

MapLevels map_levels(const Scene& scene, const Material& m, const UsedMap& map, const MapId& id, const Jobs& jobs)
{
    const Image& image = map_image(scene, *map.ref);
    const Texture& texture = texture_of(scene, *map.ref);
    if (!map.coupled)
        return make_map_levels(image, texture, id, nullptr, jobs);
    constexpr float kOne = 1.0f;
    Image facing = facing_of(normals_of(scene, m), jobs);
    if (facing.width != image.width || facing.height != image.height)
        facing = linear_map(facing, {image.width, image.height, texture.wrap_s, texture.wrap_t, texture.nearest}, false, 0, 1, &kOne);
    return make_map_levels(image, texture, id, &facing, jobs);
}

const MapLevels* find_map(const std::vector<MapLevels>& maps, const MapId& id, const Image& image)
{
    const auto found =
        std::find_if(maps.begin(), maps.end(), [&](const MapLevels& levels) { return levels.id == id && are_of(levels, image); });
    return found == maps.end() ? nullptr : &*found;
}

const MapLevels* given_map(const Scene& scene, const SceneMips& mips, const Material& m, const UsedMap& map)
{
    const Image& image = map_image(scene, *map.ref);
    const auto may_be = [&](const MapLevels& of) {
        return of.id.part == map.part && of.id.kernel == map.kernel && (of.id.normals != 0) == map.coupled && are_of(of, image);
    };
    for (const auto& there : {mips.baked, mips.cached})
        if (there && std::any_of(there->maps.begin(), there->maps.end(), may_be))
            if (const MapLevels* found = find_map(there->maps, map_id(scene, m, map, Jobs(1)), image))
                return found;
    return nullptr;
}

} // namespace burnish
