// The environment for renderers: a prefiltered cube map, diffuse irradiance and the DFG table. It is baked once and cached. Orientation
// (glTF#1761): the centre of the equirectangular image is +X, up is +Y, and u grows towards +Z. A direction d has u = 1/2 + atan2(d.z,
// d.x) / (2 pi), v = acos(d.y) / pi.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/column.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// A cube map with mip levels, largest first. Faces: +x -x +y -y +z -z, each (size+2)^2 RGBA half texels. A border of one texel comes from
// the neighbouring faces (corners: mean of the three), so a 2x2 bilinear footprint never leaves its face. A pair of texels is one 16-byte
// load. Alpha is 1.
struct CubeMap {
    int size = 0; // texels along an edge of level 0, power of two
    int levels = 0;
    std::vector<std::uint32_t> offset;        // offset of face 0 by level, in texels; faces are (size_l + 2)^2 texels apart
    Column<std::uint16_t> texels;             // 4 halves per texel
    float scale = 1.0f;                       // multiplies fetched values: keeps suns within half range, and exposes
    std::size_t level_texels(int level) const // all faces, with borders
    {
        const std::size_t side = static_cast<std::size_t>(size >> level) + 2;
        return 6 * side * side;
    }
};

// A small strong light extracted from the environment: an evenly bright ellipse on the sky. Directions as in the cubes.
struct ExtractedLight {
    float direction[3];         // unit
    float axis_u[3], axis_v[3]; // half axes of an ellipse with the light's moments and mean radiance, as tangents; |u| >= |v|
    float irradiance[3];        // linear RGB, on a surface facing the light; exposure included
    float angular_radius;       // of a disc with the ellipse's area, radians
    float share;                // share of the environment's luminance over the sphere, (0, 1]
};

struct Environment {
    std::string name;
    float rotation_deg = 0.0f; // drawing angle about +Y, counter-clockwise seen from above; the data below is not turned
    // Neither cube holds extracted lights. With EnvironmentOptions::picture_only both are empty, except specular's level 0 if there are no
    // extracted lights.
    CubeMap specular;                             // level 0: the environment; level l: GGX with roughness = l / (levels - 1)
    CubeMap irradiance;                           // cosine-weighted mean radiance (irradiance / pi), one level, 32^2 faces
    std::vector<ExtractedLight> extracted_lights; // strongest first
    CubeMap whole;                                // level 0 with extracted lights; empty if there are none
    const CubeMap& picture() const { return extracted_lights.empty() ? specular : whole; } // its level 0 is the full environment
    double energy_source = 0.0,
           energy_cube = 0.0; // mean luminance over the sphere before and after, exposure included
    float peak_source = 0.0f; // largest channel value in the source, exposure included
    double bake_ms = 0.0;     // wall time of this bake, or of reading the cache
    bool from_cache = false;
    std::uint64_t content_hash = 0;    // of source pixels and all options
    std::vector<std::string> warnings; // one line each: repaired pixels, an unwritable cache
    std::vector<std::string> files;    // for a glTF file: paths of every file read for its light
};

inline constexpr int kMaxEnvironmentSamples = 65536;
inline constexpr float kMaxEnvironmentExposure = 32.0f; // stops in both directions

struct EnvironmentOptions {
    // Applied after the bake and the cache:
    float rotation_deg = 0.0f; // turns the environment about +Y, counter-clockwise seen from above
    float exposure_ev = 0.0f;  // multiplies radiance by 2^ev
    // Options of the bake:
    int cube_size = 512;       // power of two, 4 to 4096
    int levels = 0;            // 0: log2(cube_size), down to 2^2 texels a face
    int extracted_lights = 8;  // most lights to extract, 0 to 8
    int samples = 1024;        // approximate number of light pieces in a texel's sum; 1 to kMaxEnvironmentSamples
    bool picture_only = false; // bake only picture() and the extracted lights, uncached, unless a bake is cached; for the reference
    bool use_cache = true;
    std::string cache_dir; // empty: $XDG_CACHE_HOME/burnish or ~/.cache/burnish
    bool quiet = true;     // no progress bar
};

// Bakes an equirectangular image (f32, any size), or finds the result in the cache.
Result<Environment> bake_environment(const Image& equirect, const std::string& name, const EnvironmentOptions& options, const Jobs& jobs);
// Loads an environment. spec: "builtin:NAME", the path of an equirectangular image, a .gltf or .glb file whose scene has an image-based
// light, or output from `burnish bake environment`, which keeps its own bake options.
Result<Environment> load_environment(const std::string& spec, const EnvironmentOptions& options, const Limits& limits, const Jobs& jobs);

// Returns the cube's level 0 with box-filtered levels, for techniques that choose a level by a sample's solid angle.
CubeMap box_filtered_chain(const CubeMap& environment, const Jobs& jobs);

// Directional albedo of GGX with height-correlated Smith masking (split-sum DFG): F = F0 * scale + F90 * bias (Schlick). Row: roughness
// (perceptual roughness) = y / (size - 1). Column: n.v = x / (size - 1).
struct DfgTable {
    int size = 0;
    Column<float> pairs; // size * size pairs (scale, bias), for shading/surface/dfg.k.h
};
// Bakes the table. samples: directions per entry, rounded down to a square number.
DfgTable bake_dfg(int size, int samples, const Jobs& jobs);

// Side of the albedo table for lobes with two widths. The table has size^4 / 4 pairs as in DfgTable. Order and axes: lobe_albedo_lookup()
// in shading/surface/energy.k.h. The axes n.v and roughness have `size` entries, anisotropy and azimuth half as many. size: even, at least
// 4.
inline constexpr int kLobeAlbedoSize = 20;
// Bakes the albedo table. It depends on nothing but its size and has the same bits everywhere.
Column<float> bake_lobe_albedo(int size, const Jobs& jobs);
// Returns the table for kLobeAlbedoSize, made when the program was built.
const float* lobe_albedo_pairs();
std::size_t lobe_albedo_bytes();
// Bakes the albedo of one lobe with widths alpha_x >= alpha_y: kLobeSliceSize^2 / 2 pairs for lobe_slice_lookup().
void bake_lobe_slice(double alpha_x, double alpha_y, float* pairs);
// Bakes the albedo of an Ashikhmin-Shirley lobe with exponents 1 / alpha^2.
void bake_phong_slice(int size, double alpha_x, double alpha_y, float* pairs);

} // namespace burnish
