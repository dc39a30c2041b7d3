#include "core/scene/texture.h"

#include <algorithm>
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

} // namespace burnish
