// Converts surface maps from other encodings to the scene's encodings.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/image/image.h"

namespace burnish {

enum class RotationEncoding : std::uint8_t {
    vector,       // red and green: the unit direction
    double_angle, // red and green: cosine and sine of twice the angle; filtering leaves no seam
    direction     // KHR_materials_anisotropy: the direction in [0,1]^2, blue: strength
};

// The direction that strokes in a picture show. The stretched highlight runs across grooves.
enum class Strokes : std::uint8_t { grooves, highlights };

struct SurfaceMap {
    Image image;
    std::size_t repaired = 0; // texels that were invalid or not numbers
};

// Signed values of quaternions, vectors and double angles: 8-bit code 128 and 16-bit code 32768 mean 0, the largest
// code means 1. Floats are the values themselves.

// Converts quaternions (a; b, c, 0) in red, green and blue, which rotate (0,0,1) to the normal, to a 16-bit glTF normal
// map. Repaired texels become flat.
SurfaceMap normals_of_quaternions(const Image& quaternions);

// Converts a normal map to the shortest rotations onto its normals, in `type`. Repairs normals without length.
SurfaceMap quaternions_of_normals(const Image& normals, PixelType type);

// Converts to a 16-bit KHR_materials_anisotropy texture. All encodings of a direction give one result, and d equals -d.
// Strength is 1 where the encoding has none. Repaired texels point along the tangent.
SurfaceMap directions_of_rotations(const Image& rotations, RotationEncoding encoding);

// Repairs a glTF normal map's normals that have no length or are not numbers, as float images may hold. Repaired texels
// become flat.
SurfaceMap whole_normals(Image normals);

// Returns the red channel of a picture where a texel of another size lies, [0,65535]. An empty picture has the largest value.
std::uint16_t red_at(const Image& image, int x, int y, int width, int height);

// Packs the red channels of two maps as glTF does: green roughness, blue metalness. The result has the larger width and height, and 8 bits
// where both maps have no more. An empty map counts as 1.
Image metal_rough_of(const Image& metallic, const Image& roughness);
std::uint64_t metal_rough_bytes(const Image& metallic, const Image& roughness); // of that picture

// Converts a DirectX normal map, whose green points down, to glTF. Exact.
void flip_green(Image& normals);

} // namespace burnish
