// Mip filters by name, and what they make: levels of a material's normals and lobes.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

// A line of BN_MIP_FILTER in shading/models.def, by its place.
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
const std::vector<MipFilterInfo>& mip_filters(); // from shading/models.def, by place

// Whether levels have gains, and for what: frames, where texels that turn away from the eye are as at grazing angles, or the light that
// levels are judged by (shown.h), where they are dark.
enum class Gains { none, of_frames, as_judged };

std::uint32_t gained_of(mipnet::Lobe lobe, bool metal);
bool gained_metal(std::uint32_t gained); // whether they are those of a metal

bool makes_lobes(MipFilter filter); // levels of lobes, all but box and lean
bool takes_net(MipFilter filter);   // and its lobe
bool takes_kappa(MipFilter filter);
inline constexpr double kMostKappa = 4.0; // the least is 0
bool takes_gains(MipFilter filter);       // of reflectances: those that err less with them under lamps, see bench/lab/notebook/mip_nets.md

// What the normals of a fetch's texels differ by, as part of the lobe's covariance: (gain n)(gain n)^T of x and y of unit normals.
float gain_of_taps(MipFilter filter, float kappa);

struct MipTexel {
    float nx, ny;  // of a unit normal in tangent space, z > 0
    float a, b, c; // the lobe in that normal's frame: lobe_tensor, projected
    bool operator==(const MipTexel&) const = default;
};

struct MipLevel {
    int width, height;
    std::vector<MipTexel> texels; // rows from the top
    float gain = 1.0f;            // of reflectances, see level_gains.h
};

struct MipLevels {
    MipFilter filter = MipFilter{};
    float kappa = 0.0f;           // of filter kappa, and of the taps of mipnet and teacher; else 0
    std::uint64_t source = 0;     // hash of level 0
    std::uint64_t net = 0;        // levels_hash() of what mipnet made them by, teacher began with; else 0
    std::uint32_t gained = 0;     // what gains are of: 0: they are 1; else gained_of()
    int width = 0, height = 0;    // of level 0
    std::vector<MipLevel> levels; // from 1 on; none of a single texel
};

// Maps whose levels are means: linear base colours, with alpha where there is any; metallic-roughness as its map has it; heights, which
// are the alpha of normal maps.
enum class MapPart : std::uint32_t { base_color, metallic_roughness, height };

// box: the mean over a texel's exact footprint. kaiser: a sinc over three texels of the level either way under Kaiser's window (alpha 4):
// sharper, and clamped to what the map holds.
enum class ColourKernel : std::uint32_t { box, kaiser };

struct MapId { // what levels of a map are made of
    MapPart part = MapPart::base_color;
    ColourKernel kernel = ColourKernel::box;
    std::uint64_t source = 0;  // map_hash()
    std::uint64_t normals = 0; // hash of the normals that weigh (MipSource::hash); 0: none do
    bool operator==(const MapId&) const = default;
};

struct MapLevels {
    MapId id;
    int width = 0, height = 0, channels = 0;        // of level 0; channels 1 (gray, heights), 3 or 4
    std::vector<std::vector<std::uint16_t>> levels; // from 1 on: halves, rows from the top, channels of a texel side by side
};

struct MipFile { // pyramid_file.h
    std::vector<MipLevels> materials;
    std::vector<MapLevels> maps;
};

} // namespace burnish
