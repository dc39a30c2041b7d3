// Layers of a picture as channels of a file: what `--aov` names.
#pragma once
#include <string>
#include <vector>

#include "raster/frame/frame.h"

namespace burnish {

struct LayerInfo {
    std::string name;                  // "object-id"
    std::vector<std::string> channels; // of an OpenEXR file
    int first_word;                    // of PixelLayers; -1: numbers of the scene, which follow from the triangle
};
// Those of shading/layers.def, then object-id (1 + the node's place in the scene) and material-id (1 + the material's).
const std::vector<LayerInfo>& layers();

// What a frame has to be drawn with.
void ask_for_layers(const std::vector<std::string>& names, FrameDesc& desc);

struct NamedChannels {
    Image image; // f32, a channel a name
    std::vector<std::string> names;
};
// The picture's own channels (R, G, B and A, where it has that) and those of the layers. Where nothing is seen depth is infinite and all
// else 0. frame: drawn as ask_for_layers() says, of these tables.
NamedChannels with_layers(const Image& color, const Frame& frame, const DrawTables& tables, const std::vector<std::string>& names);

} // namespace burnish
