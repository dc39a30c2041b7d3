// Maps of a surface in other encodings than scenes hold, turned into those.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/image/image.h"

namespace burnish {

enum class RotationEncoding : std::uint8_t {
    vector,       // red and green: the unit direction
    double_angle, // red and green: cosine and sine of twice its angle, of which filters make no seam
    direction     // KHR_materials_anisotropy: the direction in [0,1]^2, blue: strength
};

struct SurfaceMap {
    Image image;
    std::size_t repaired = 0; // texels that held nothing of their kind, or no numbers
};

// Signed values of quaternions, vectors and double angles: code 128 of 8 bits and 32768 of 16 is 0, the largest 1; floats are values
// themselves.

// Quaternions (a; b, c, 0) in red, green and blue, which turn (0,0,1) to the normal, as a normal map (glTF) of 16 bits. Repaired: level.
SurfaceMap normals_of_quaternions(const Image& quaternions);

// The other way: the shortest rotations to a normal map's normals, of 8 bits or floats. Repaired: of normals without length.
SurfaceMap quaternions_of_normals(const Image& normals, PixelType type);

// As a texture of KHR_materials_anisotropy of 16 bits, the same one whichever encoding says a direction: d and -d are one. Strength is 1
// where the encoding has none. Repaired: along the tangent.
SurfaceMap directions_of_rotations(const Image& rotations, RotationEncoding encoding);

// A normal map (glTF) without normals that have no length or are no numbers, as pictures of floats may have them. Repaired: level.
SurfaceMap whole_normals(Image normals);

// A normal map whose green points down, as DirectX has it, to one of glTF, exactly.
void flip_green(Image& normals);

} // namespace burnish
