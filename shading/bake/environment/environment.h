// The environment as the renderers use it: a cube map with its prefiltered chain, diffuse irradiance and the
// DFG table, baked once and cached. Orientation (glTF#1761): the centre of the equirectangular image is +X,
// up is +Y, and u grows towards +Z: a direction d has u = 1/2 + atan2(d.z, d.x) / (2 pi), v = acos(d.y) / pi.
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

// Faces +x -x +y -y +z -z, each (size+2)^2 texels of RGBA half with a border of one texel copied from the
// neighbouring faces (corners: mean of the three), so a 2x2 bilinear footprint never leaves its face. Levels
// follow each other, largest first. A texel pair is one 16-byte load. Alpha is 1.
struct CubeMap {
    int size = 0; // texels along an edge of level 0, power of two
    int levels = 0;
    std::vector<std::uint32_t> offset;        // by level, in texels, of face 0; faces are (size_l + 2)^2 texels apart
    Column<std::uint16_t> texels;             // 4 halves a texel
    float scale = 1.0f;                       // multiplies what is fetched: keeps suns within half range, and exposes
    std::size_t level_texels(int level) const // of all faces, with their borders
    {
        const std::size_t side = static_cast<std::size_t>(size >> level) + 2;
        return 6 * side * side;
    }
};

// A small strong light of the environment, as an evenly bright ellipse on the sky. Directions as in the cubes.
struct KeyLight {
    float direction[3];         // unit
    float axis_u[3], axis_v[3]; // half axes of the ellipse that has its light's moments and mean radiance, as tangents; |u| >= |v|
    float irradiance[3];        // linear RGB, on a surface that faces it; exposure included
    float angular_radius;       // of the disc that has the ellipse's area, radians
    float share;                // of the environment's luminance over the sphere, (0, 1]
};

struct Environment {
    std::string name;
    float rotation_deg = 0.0f; // that it is drawn with, about +Y, counter-clockwise seen from above; what follows is not turned
    // Both without the key lights; with EnvironmentOptions::picture_only empty, but for level 0 where there are no key lights.
    CubeMap specular;                 // level 0: the environment; level l: GGX with alpha_lin = l / (levels - 1)
    CubeMap irradiance;               // cosine-weighted mean radiance (irradiance / pi), one level, 32^2 faces
    std::vector<KeyLight> key_lights; // the strongest first
    CubeMap whole;                    // level 0 with them; empty where there are none
    const CubeMap& picture() const { return key_lights.empty() ? specular : whole; } // whose level 0 is all of it
    double energy_source = 0.0,
           energy_cube = 0.0; // mean radiance (luminance) over the sphere before and after, exposure included
    float peak_source = 0.0f; // largest channel value in the source, exposure included
    double bake_ms = 0.0;     // wall time of this bake, or of reading the cache
    bool from_cache = false;
    std::uint64_t content_hash = 0;    // of source pixels and all options
    std::vector<std::string> warnings; // one line each: repaired pixels, an unwritable cache
    std::vector<std::string> files;    // paths of every file that a glTF file's light was read from; else none
};

struct EnvironmentOptions {
    // No part of what is baked and cached:
    float rotation_deg = 0.0f; // turns the environment about +Y, counter-clockwise seen from above
    float exposure_ev = 0.0f;  // radiance is multiplied by 2^ev
    // The bake:
    int cube_size = 512;       // power of two, 4 to 4096
    int levels = 0;            // 0: log2(cube_size), down to 2^2 texels a face
    int key_lights = 8;        // that may leave the environment, 0 to 8
    int samples = 1024;        // pieces of light that a texel of a prefiltered level sums, about; 1 to 65536
    bool picture_only = false; // nothing but picture() and the key lights, where no bake is cached; that is not cached. For the reference
    bool use_cache = true;
    std::string cache_dir; // empty: $XDG_CACHE_HOME/burnish or ~/.cache/burnish
    bool quiet = true;     // no progress bar
};

// Bakes from an equirectangular image (f32, any size), or finds the result in the cache.
Result<Environment> bake_environment(const Image& equirect, const std::string& name, const EnvironmentOptions& options, const Jobs& jobs);
// `spec`: "builtin:NAME", a path of an equirectangular image, a .gltf or .glb file whose scene has an image-based light, or what `burnish
// bake environment` wrote, whose own options of the bake hold.
Result<Environment> load_environment(const std::string& spec, const EnvironmentOptions& options, const Limits& limits, const Jobs& jobs);

// The same level 0 with a box-filtered chain under it, for techniques that choose a level by the solid angle of a sample.
CubeMap box_filtered_chain(const CubeMap& environment, const Jobs& jobs);

// Directional albedo of GGX with height-correlated Smith (split-sum DFG): F = F0 * scale + F90 * bias
// (Schlick). Row: alpha_lin (perceptual roughness) = y / (size - 1); column: n.v = x / (size - 1).
struct DfgTable {
    int size = 0;
    Column<float> pairs; // size * size of (scale, bias), for shading/surface/dfg.k.h
};
// samples: directions an entry is integrated over; their number is rounded down to a square.
DfgTable bake_dfg(int size, int samples, const Jobs& jobs);

// The same for lobes of two widths: size^4 / 4 pairs as DfgTable's, whose order and axes are those of lobe_albedo_lookup() in
// shading/surface/energy.k.h. size, along n.v and roughness, half of it along anisotropy and azimuth: even, at least 4.
inline constexpr int kLobeAlbedoSize = 20;
// A constant of mathematics: the same bits everywhere.
Column<float> bake_lobe_albedo(int size, const Jobs& jobs);
// That of kLobeAlbedoSize, made when the program was built.
const float* lobe_albedo_pairs();
std::size_t lobe_albedo_bytes();
// The same for one lobe, of widths alpha_x >= alpha_y: kLobeSliceSize^2 / 2 pairs for lobe_slice_lookup().
void bake_lobe_slice(double alpha_x, double alpha_y, float* pairs);
// And for an Ashikhmin-Shirley lobe of exponents 1 / alpha^2.
void bake_phong_slice(int size, double alpha_x, double alpha_y, float* pairs);

} // namespace burnish
