// A picture's layers as channels in a file.
#pragma once
#include <string>
#include <vector>

#include "raster/frame/frame.h"

namespace burnish {

struct LayerInfo {
    std::string name;                  // "object-id"
    std::vector<std::string> channels; // in an OpenEXR file
    int first_word;                    // in PixelLayers; -1: scene numbers, which follow from the triangle
};
// Lists the layers in shading/layers.def, then object-id (1 + the node's index in the scene) and material-id (1 + the material's index).
const std::vector<LayerInfo>& layers();

// Sets the description's flags so that a frame has the data for these layers. Errors: ExitCode::usage for an unknown name.
Status ask_for_layers(const std::vector<std::string>& names, FrameDesc& desc);

struct NamedChannels {
    Image image; // f32, a channel a name
    std::vector<std::string> names;
};
// Returns the picture's channels (R, G, B, and A if present) and the layers' channels. Empty pixels have infinite depth and 0 in other
// layers. frame: drawn from these tables with a description from ask_for_layers(). Errors: ExitCode::usage for an unknown name, a picture
// that is not f32 with 3 channels or more, or a frame of another size or without the layers' data.
Result<NamedChannels> with_layers(const Image& color, const Frame& frame, const DrawTables& tables, const std::vector<std::string>& names);

} // namespace burnish
