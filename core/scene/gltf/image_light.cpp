#include "core/scene/gltf/image_light.h"

#include <algorithm>
#include <fmt/format.h>

#include "core/scene/gltf/graph.h"
#include "core/scene/gltf/image.h"

namespace burnish::gltf {

namespace {

constexpr const char* kName = "EXT_lights_image_based";
constexpr std::size_t kCoefficients = 9; // of spherical harmonics, three numbers each

std::string place_of(int light)
{
    return fmt::format("/extensions/{}/lights/{}", kName, light);
}

// Returns the light of the shown scene, or -1.
int shown_light(const Document& doc)
{
    if (table_size(doc.json, "scenes") == 0)
        return -1;
    const std::size_t scene = static_cast<std::size_t>(std::max(get_index(doc.json, "scene"), 0));
    const Json* extension = get_extension(doc.json["scenes"][scene], kName);
    return extension ? get_index(*extension, "light") : -1;
}

const Json& list_of(const Json& light, const char* key, const std::string& place)
{
    const Json* list = get_member(light, key);
    if (!list)
        fail(place, fmt::format("\"{}\" is missing", key));
    if (!list->is_array() || list->empty())
        fail(place + "/" + key, "must be an array that is not empty");
    return *list;
}

void check_image_light(Document& doc, const Json& light, const std::string& place)
{
    if (const std::size_t count = list_of(light, "irradianceCoefficients", place).size(); count != kCoefficients)
        fail(place + "/irradianceCoefficients", fmt::format("must be an array of {} coefficients, has {}", kCoefficients, count));
    const std::size_t levels = list_of(light, "specularImages", place).size();
    const std::uint64_t size = get_uint(light, "specularImageSize", 0);
    if ((size & (size - 1)) != 0)
        doc.fault(place + "/specularImageSize", "is no power of two");
    if (levels > 64 || size >> (levels - 1) == 0)
        fail(place + "/specularImages", fmt::format("{} levels are more than {} texels halve to", levels, size));
    const std::uint64_t pixels = 8 * size * size; // of the full-sky image that the light becomes
    if (pixels > doc.limits.env_pixels)
        fail(place + "/specularImageSize",
             fmt::format("an environment of such faces has {} pixels, more than {} (Limits::env_pixels)", pixels, doc.limits.env_pixels));
}

} // namespace

void check_image_lights(Document& doc)
{
    const Json* extension = get_extension(doc.json, kName);
    for (std::size_t i = 0; extension && i < table_size(*extension, "lights"); ++i)
        check_image_light(doc, (*extension)["lights"][i], place_of(static_cast<int>(i)));
    doc.scene.image_light = shown_light(doc) >= 0;
}

ImageLight read_image_light(Document& doc)
{
    const int index = shown_light(doc);
    if (index < 0)
        fail("/scenes", fmt::format("the scene has no image-based light ({})", kName));
    const std::string place = place_of(index);
    const Json& source = (*get_extension(doc.json, kName))["lights"][static_cast<std::size_t>(index)];
    ImageLight light;
    light.size = get_index(source, "specularImageSize");
    light.intensity = get_number(source, "intensity", 1.0);
    light.world_from_cube = glm::dmat3(trs_matrix({{"rotation", source.value("rotation", Json({0.0, 0.0, 0.0, 1.0}))}}, place));
    const std::vector<int> faces = source["specularImages"][0].get<std::vector<int>>();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& face = doc.scene.images[static_cast<std::size_t>(scene_image(doc, faces[i], false))];
        if (face.width != light.size || face.height != light.size)
            fail(fmt::format("{}/specularImages/0/{}", place, i), fmt::format("image {} is {}x{}, not {}x{} as specularImageSize says",
                                                                              faces[i], face.width, face.height, light.size, light.size));
        light.faces.push_back(face);
    }
    light.files = doc.scene.files;
    return light;
}

} // namespace burnish::gltf
