// Mip filters by name, and their output: levels for a material's normals and lobes.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

// A BN_MIP_FILTER line in shading/models.def, by its place.
enum class MipFilter : std::int32_t {};

namespace mipnet {
struct Weights;
enum class Lobe : std::uint32_t;
} // namespace mipnet

#define BN_MIP_FILTER(id, at, name, summary) inline constexpr MipFilter kMipFilter_##id = static_cast<MipFilter>(at);
#include "shading/models.def"

struct MipFilterInfo {
    const char* name;
    const char* summary;
};
const std::vector<MipFilterInfo>& mip_filters(); // from shading/models.def, in order

// The purpose that the levels' gains serve. of_frames: texels that turn away from the eye count as at grazing angles. as_judged: such
// texels are dark, as in the light that judges levels (mip_error.h).
enum class Gains { none, of_frames, as_judged };

// Returns the gains' code for a lobe and a metal or dielectric, for MipLevels::gained.
std::uint32_t gained_of(mipnet::Lobe lobe, bool metal);
bool gained_metal(std::uint32_t gained); // true for a metal's gains

bool makes_lobes(MipFilter filter); // all but box and lean
bool takes_net(MipFilter filter);   // and the net's lobe
bool takes_kappa(MipFilter filter);
inline constexpr double kMostKappa = 4.0; // the least is 0
bool takes_gains(MipFilter filter);       // true for filters that err less with gains under lamps, see bench/lab/notebook/mip_nets.md

// Returns the weight for normals that differ between a fetch's texels. The lobe's covariance gets (gain n)(gain n)^T from unit normals' x
// and y.
float gain_of_taps(MipFilter filter, float kappa);

struct MipTexel {
    float nx, ny;  // unit normal in tangent space, z > 0
    float a, b, c; // the lobe in that normal's frame: lobe_tensor, projected
    bool operator==(const MipTexel&) const = default;
};

struct MipLevel {
    int width, height;
    std::vector<MipTexel> texels; // rows from the top
    float gain = 1.0f;            // factor on reflectances, see level_gains.h
};

struct MipLevels {
    MipFilter filter = MipFilter{};
    float kappa = 0.0f;           // for filter kappa, and for taps on a net's and on optimised levels; else 0
    std::uint64_t source = 0;     // level 0's hash
    std::uint64_t net = 0;        // the net's levels_hash() for a net's and for optimised levels; else 0
    std::uint32_t gained = 0;     // 0: gains are 1; else gained_of()
    int width = 0, height = 0;    // of level 0
    std::vector<MipLevel> levels; // from 1 on; empty for a single texel
};

// Maps whose levels are means. base_color: linear, with alpha if present. metallic_roughness: as stored in the map. height: a normal map's
// alpha.
enum class MapPart : std::uint32_t { base_color, metallic_roughness, height };

// box: the mean over a texel's exact footprint. kaiser: a sinc with Kaiser's window (alpha 4), three level texels to each side. It
// is sharper; results are clamped to the map's range.
enum class ColourKernel : std::uint32_t { box, kaiser };

struct MapId { // identifies the inputs for a map's levels
    MapPart part = MapPart::base_color;
    ColourKernel kernel = ColourKernel::box;
    std::uint64_t source = 0;  // map_hash()
    std::uint64_t normals = 0; // hash of the normals that weight colours (MipSource::hash); 0: no weights
    bool operator==(const MapId&) const = default;
};

struct MapLevels {
    MapId id;
    int width = 0, height = 0, channels = 0;        // of level 0; channels 1 (gray, heights), 3 or 4
    std::vector<std::vector<std::uint16_t>> levels; // from 1 on: halves, rows from the top, a texel's channels side by side
};

struct MipFile { // pyramid_file.h
    std::vector<MipLevels> materials;
    std::vector<MapLevels> maps;
};

} // namespace burnish
