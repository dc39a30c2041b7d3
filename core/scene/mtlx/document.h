// Reads MaterialX documents: surface materials whose inputs are numbers or pictures.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish::mtlx {

struct PictureInput {
    std::string file;                                            // as the document has it, with its prefix
    bool encoded = false;                                        // a picture of colours, stored in sRGB
    glm::vec2 scale = glm::vec2(1.0f), offset = glm::vec2(0.0f); // place in the picture = coordinates * scale + offset, v down
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;
    int channel = 0;                     // of an input that takes one number
    bool one_channel = false;            // the document names the channel
    glm::vec4 factor = glm::vec4(1.0f);  // on the picture's values
    std::optional<float> normal_scale{}; // of a normal map; empty: the picture passes no normal map
};

struct Input {
    std::string name;
    glm::vec3 value = glm::vec3(0.0f); // a single number fills all three; colours are linear Rec.709
    float alpha = 1.0f;                // of a constant with four numbers
    std::optional<PictureInput> picture{};
};

struct SurfaceMaterial {
    std::string name; // the material's
    std::string kind; // standard_surface, open_pbr_surface or gltf_pbr
    std::vector<Input> inputs;
};

// Reads a document. path: for errors. Errors (ExitCode::bad_input), each with the element's name: text that is no XML; another version than
// 1.38 or 1.39; includes, surfaces of another kind or within node graphs, inputs that come from other nodes than pictures, constants,
// channels of these, and products with constants; values that are no finite numbers; colour spaces other than Rec.709, sRGB and ACEScg
// (ACEScg for numbers alone); too many nodes; no material at all. Colours without a colour space are linear Rec.709. Inputs that are linked
// to the geometry's own normal or tangent count as absent.
Result<std::vector<SurfaceMaterial>> read_document(std::string_view text, const std::string& path);

} // namespace burnish::mtlx
