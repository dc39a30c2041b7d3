#include "core/scene/direction_map.h"

#include <algorithm>
#include <fmt/core.h>
#include <utility>

#include "core/image/io/image_io.h"

namespace burnish {

Status put_direction_map(Scene& scene, const std::string& path, const Limits& limits)
{
    const auto refuse = [&path](const std::string& reason) { return Error{ExitCode::bad_input, path, "", reason}; };
    std::vector<bool> mapped(scene.materials.size(), false);
    bool any = false;
    for (const Primitive& primitive : scene.primitives)
        if (primitive.has_uv0)
            any = mapped[static_cast<std::size_t>(primitive.material)] = true;
    if (!any)
        return refuse("nothing in the scene has texture coordinates for a map of directions");

    Limits rest = limits;
    for (const Image& image : scene.images)
        rest.texture_bytes -= std::min<std::uint64_t>(rest.texture_bytes, image.bytes.size());
    Result<Image> image = read_image(path, rest);
    if (!image)
        return image.error();
    if (image->channels < 3)
        return refuse("a map of directions has red, green and blue");
    if (image->bytes.size() > rest.texture_bytes)
        return refuse(fmt::format("the scene's textures need more than {} bytes (--limit-texture-bytes)", limits.texture_bytes));
    scene.images.push_back(std::move(*image));
    scene.files.push_back(path);
    Texture texture;
    texture.name = "direction map";
    texture.image = static_cast<std::int32_t>(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    for (std::size_t i = 0; i < mapped.size(); ++i) {
        Material& material = scene.materials[i];
        if (!mapped[i])
            continue;
        material.anisotropy_tex = TextureRef();
        material.anisotropy_tex.texture = static_cast<std::int32_t>(scene.textures.size()) - 1;
        if (!(material.anisotropy_strength > 0.0f))
            material.anisotropy_strength = 1.0f;
    }
    return {};
}

} // namespace burnish
