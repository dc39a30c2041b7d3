// Image-based light of a glTF file (EXT_lights_image_based): the faces of a cube around the scene.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

struct ImageLight {
    int size = 0; // face side in texels
    // Faces +x -x +y -y +z -z, each seen from inside the cube. Three channels: sRGB. Two or four channels: the last one
    // divides the others' linear values (RGBD).
    std::vector<Image> faces;
    glm::dmat3 world_from_cube{1.0}; // a rotation
    double intensity = 1.0;          // multiplies radiance
    std::vector<std::string> files;  // paths of all files read for the light
};

// Reads the image-based light of the scene that a .gltf or .glb file shows, and nothing else. Errors: bad_input, with a
// JSON path.
Result<ImageLight> load_image_light(const std::string& path, const Limits& limits);

// Reads the light from memory, like load_gltf_bytes().
Result<ImageLight> load_image_light_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits);

// Returns true for a file that begins like glTF or has a glTF extension. Image files return false.
bool is_gltf(const std::string& path);

} // namespace burnish
