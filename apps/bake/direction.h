// Makes anisotropy direction maps from pictures.
#pragma once
#include "core/image/image.h"
#include "core/scene/surface_maps.h"

namespace burnish {

enum class DirectionFrom { hue, luminance };

// Returns an anisotropy texture (KHR_materials_anisotropy, 8 bits). The hue circle or the luminance range [0,1] becomes the angle of a
// stroke, from 0 to pi, counter-clockwise from the tangent. Red and green hold the highlight's direction, blue holds `strength` in [0,1].
// Grey pixels have hue 0. Float pictures are linear, others sRGB. Luminance is perceptually even: the sRGB value of the equally bright
// grey.
Image direction_map(const Image& picture, DirectionFrom from, Strokes strokes, double strength);

} // namespace burnish
