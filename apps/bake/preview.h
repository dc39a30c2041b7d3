// What bakers show of what they make (`--preview FOLDER`): pictures of 8 bits to be looked at, which nothing reads back.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/surface_maps.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/ltc/table.h"

namespace burnish {

struct PreviewPicture {
    std::string name; // of a file, without its extension
    Image image;
};
using Preview = std::vector<PreviewPicture>;

// Nothing where `folder` is empty. files: that the command reads and writes; a picture may be none of them.
Status check_preview(const std::string& folder, const Preview& pictures, const std::vector<std::string>& files);
// Makes the folder; names each picture in the report.
Status write_preview(const std::string& folder, const Preview& pictures, Report& report);

// A map of rotations in one of its encodings: "grain", as --direction-map reads hues: the angle off the tangent is the hue, 180 degrees
// once around; strength is the saturation.
Preview preview_of_rotations(const Image& map, RotationEncoding encoding);
// "normals": the normal map that such a map stands for.
Preview preview_of_quaternions(const Image& map);
// "half_vectors": x, y and z, -1 to 1; with four channels also "density": its logarithm, a thousandth of the most is black.
Preview preview_of_half_vectors(const Image& table);
// "albedo": red and green as they are, linear.
Preview preview_of_albedo(const Image& table);
// "radiance_LL", the levels that lobes of alpha_lin LL / (levels - 1) fetch, "irradiance", and with key lights "whole": all around (u grows
// to the right, the top is up), as a display shows them.
Preview preview_of_environment(const Environment& environment);
// "heights" as they repeat, and "normals": those that heights of `depth`, in lengths of texture coordinates, have.
Preview preview_of_heights(const Image& heights, double depth);
// "m00" to "m22", "nD", "fD": entries, each between its least and its most; theta and within it phi go down, alpha and within it lambda
// to the right.
Preview preview_of_ltc(const ltc::Table& table);
Preview names_of_ltc(); // the same without pictures, before there is a table

} // namespace burnish
