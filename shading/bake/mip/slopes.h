// Maps of a material that say how its surface leans within a texel, as something that can be filtered: moments of slopes.
#pragma once
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

struct SlopeMaps { // null where there is none; all of one place: the same coordinates see the same point in each
    // Red and green: mean slopes d height / d tangent and d height / d bitangent, -1 to 1. Code 128 of 8 bits and 32768 of 16 is 0, the
    // largest 1; floats are slopes themselves.
    const Image* tilt = nullptr;
    const Image* direction = nullptr; // KHR_materials_anisotropy
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    bool normals = false; // `tilt` is a normal map (glTF), not of slopes
};

struct SlopeFactors {
    float tilt_scale = 1.0f; // of slopes, of which at most that of 80 degrees is left
    bool with_lobe = false;  // second moments hold the lobe too, of
    float roughness = 1.0f, anisotropy_strength = 0.0f, anisotropy_rotation = 0.0f;
    float unit_gain = 0.0f; // above 0: in place of slopes of normals, so many times x and y of the unit normals
};

// An f32 image, as wide as the widest map and as high as the highest. A texel's slopes s have a mean and, with the lobe, a covariance about
// it; its moments E[s] and E[s s^T] are linear in them, so filtering the moments filters the distribution of slopes exactly. Times
// kSlopeScale and kMomentScale (shading/lang/records.h) they keep to halves' range. In two parts:
//   2: xx, yy, xy of the map's tensor of power 2 (anisotropy.h; 1, 0, 0 without a map), second moment xx
//   4: mean x, mean y, second moments yy, xy
Image slope_moments(const SlopeMaps& maps, const SlopeFactors& factors, int part);

} // namespace burnish
