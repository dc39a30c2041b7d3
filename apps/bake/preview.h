// 8-bit pictures of baked data for inspection (`--preview FOLDER`). No program reads these files back.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/surface_maps.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

struct PreviewPicture {
    std::string name; // file name without extension
    Image image;
};
using Preview = std::vector<PreviewPicture>;

Image enlarged(const Image& image); // draws each texel as a square of pixels

// Returns success for an empty `folder`. files: paths that the command reads and writes; a picture must not overwrite them.
Status check_preview(const std::string& folder, const Preview& pictures, const std::vector<std::string>& files);
// Makes the folder and reports each picture.
Status write_preview(const std::string& folder, const Preview& pictures, Report& report);

// Draws a rotation map as "grain", in the encoding of --direction-map: hue is the angle from the tangent, 180 degrees a circle;
// saturation is strength.
Preview preview_of_rotations(const Image& map, RotationEncoding encoding);
// Draws "normals": the normal map equivalent to the quaternion map.
Preview preview_of_quaternions(const Image& map);
// Draws "half_vectors": x, y and z from -1 to 1. With four channels also "density": its logarithm, black at a thousandth of the maximum.
Preview preview_of_half_vectors(const Image& table);
// Draws "albedo": red and green unchanged, linear.
Preview preview_of_albedo(const Image& table);
// Draws "radiance_LL", the level for lobes with roughness LL / (levels - 1), "irradiance" and, with extracted lights, "whole". Pictures are
// tonemapped panoramas (u grows to the right, up is at the top).
Preview preview_of_environment(const Environment& environment);
// Draws "heights" as they repeat, and "normals" for heights scaled by `depth`, in units of texture coordinates.
Preview preview_of_heights(const Image& heights, double depth);

} // namespace burnish
