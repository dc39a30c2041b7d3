// Slopes of a surface within a texel, as moments that can be filtered.
#pragma once
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

struct SlopeMaps { // null: no such map; all maps have the same layout
    // Red and green: mean slopes d height / d tangent and d height / d bitangent, -1 to 1. Code 128 of 8 bits and 32768 of 16 bits is 0,
    // the largest code 1. Floats are slopes themselves.
    const Image* tilt = nullptr;
    const Image* direction = nullptr; // KHR_materials_anisotropy
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    bool normals = false; // `tilt` is a normal map (glTF), not a slope map
};

struct SlopeFactors {
    float tilt_scale = 1.0f; // factor of slopes; results are clamped to 80 degrees
    bool with_lobe = false;  // second moments include this lobe:
    float roughness = 1.0f, anisotropy_strength = 0.0f, anisotropy_rotation = 0.0f;
    float unit_gain = 0.0f; // above 0: replaces slopes by x and y of unit normals, times this gain
};

// Returns moments as an f32 image, as wide as the widest map and as high as the highest. A texel's slopes s have a mean and, with the
// lobe, a covariance. Their moments E[s] and E[s s^T] can be filtered linearly, which filters the distribution of slopes exactly. Factors
// kSlopeScale and kMomentScale (shading/lang/records.h) keep them in half's range. There are two parts:
//   2: xx, yy, xy of the map's tensor with power 2 (anisotropy.h; 1, 0, 0 without a map), second moment xx
//   4: mean x, mean y, second moments yy, xy
Image slope_moments(const SlopeMaps& maps, const SlopeFactors& factors, int part);

} // namespace burnish
