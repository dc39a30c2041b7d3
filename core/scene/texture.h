// Scene textures: wrap modes, and making a texture from an image.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

// Returns the texel in [0, count) that `mode` maps `at` to. `at` may be negative or beyond count.
int wrapped_at(std::int64_t at, int count, WrapMode mode);

// Appends the image and a texture for it. The texture repeats or copies the sampler of `like`. Returns the texture's
// index.
std::int32_t add_texture(Scene& scene, const char* name, Image image, Texture like = {});

// Returns how much of Limits::texture_bytes the scene's images leave.
std::uint64_t texture_bytes_left(const Scene& scene, const Limits& limits);

// Returns the limits on a further picture: texture_bytes is what the images leave.
Limits limits_left(const Scene& scene, const Limits& limits);

// Returns the error of a file whose texture needs more.
Error textures_too_large(const std::string& path, const Limits& limits);

} // namespace burnish
