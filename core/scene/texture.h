// Textures of a scene: what a sampler sees beyond a border, and how a picture becomes one.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

// The texel of `count` along an axis that one at `at` stands for, below 0 and from `count` on too.
int wrapped_at(std::int64_t at, int count, WrapMode mode);

// Appends the image and a texture of it, which repeats or has the sampler of `like`; returns the texture's number.
std::int32_t add_texture(Scene& scene, const char* name, Image image, Texture like = {});

} // namespace burnish
