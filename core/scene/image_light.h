// An image-based light of a glTF file (EXT_lights_image_based): the faces of a cube around the scene.
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
    int size = 0; // texels a side of every face
    // +x -x +y -y +z -z, each as it is seen from within the cube. Three channels: sRGB. Two or four: the last is a divisor of the others'
    // linear values (RGBD).
    std::vector<Image> faces;
    glm::dmat3 world_from_cube{1.0}; // a rotation
    double intensity = 1.0;          // multiplies radiance
    std::vector<std::string> files;  // paths of every file that was read for it
};

// That of the scene which a .gltf or .glb file shows; nothing else of it is read. Errors: bad_input, with a JSON path.
Result<ImageLight> load_image_light(const std::string& path, const Limits& limits);

// The same from memory, as load_gltf_bytes().
Result<ImageLight> load_image_light_bytes(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits);

// Whether there is a file that begins as glTF does, or is called so. No picture does.
bool is_gltf(const std::string& path);

} // namespace burnish
