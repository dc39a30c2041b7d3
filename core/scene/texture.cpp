#include "core/scene/texture.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace burnish {

int wrapped_at(std::int64_t at, int count, WrapMode mode)
{
    const std::int64_t n = count;
    if (mode == WrapMode::clamp)
        return static_cast<int>(std::clamp<std::int64_t>(at, 0, n - 1));
    const std::int64_t period = mode == WrapMode::mirror ? 2 * n : n, in = (at % period + period) % period;
    return static_cast<int>(in < n ? in : period - 1 - in);
}

std::int32_t add_texture(Scene& scene, const char* name, Image image, Texture like)
{
    like.name = name, like.image = static_cast<std::int32_t>(scene.images.size());
    scene.images.push_back(std::move(image));
    scene.textures.push_back(std::move(like));
    return static_cast<std::int32_t>(scene.textures.size()) - 1;
}

std::uint64_t texture_bytes_left(const Scene& scene, const Limits& limits)
{
    std::uint64_t left = limits.texture_bytes;
    for (const Image& image : scene.images)
        left -= std::min<std::uint64_t>(left, image.bytes.size());
    return left;
}

Limits limits_left(const Scene& scene, const Limits& limits)
{
    Limits left = limits;
    left.texture_bytes = texture_bytes_left(scene, limits);
    return left;
}

Error textures_too_large(const std::string& path, const Limits& limits)
{
    return {ExitCode::bad_input, path, "",
            fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits.texture_bytes)};
}

} // namespace burnish
