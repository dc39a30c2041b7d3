// A scene's settings for mip filters, and each material's filter.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

enum class MipFallback { automatic, off }; // automatic: materials are left to closed forms where the net is worse than it may be
inline constexpr float kDefaultMipKappa =
    0.7f; // for every lobe model: makes the least error among the numbers tried (bench/lab/notebook/mip_filters.md)

struct MipSettings {             // of all materials
    MipFilter filter{};          // the first: the level file's filter, where there is a file
    std::optional<float> kappa;  // for filters kappa and mipnet; none: kDefaultMipKappa
    std::string net;             // file of weights for filter mipnet; empty: those in the library
    int brdf = 0;                // lobe model that the library's weights and gains are for, a place in BN_LOBE
    MipFallback fallback{};      // of filter mipnet
    bool gains = false;          // levels' reflectances are multiplied by their gains
    bool couple_albedo = false;  // levels' base colours and metalness weigh as their texels face light and eye
    bool kaiser_colours = false; // and are averaged by ColourKernel::kaiser
    bool facets = true;          // false: strong normal maps are drawn by their levels from afar too, as in engines
    std::string pyramid;         // file of levels, as in pyramid_file.h
    int threads = 0;             // that make levels; 0: all cores
    bool use_cache = false;      // levels that take long are looked for in the cache, and stored there
    bool box_asked = false;      // filter box is asked for by name, and leaves no choice to the level file
    bool frames_override = true; // false: no frame sets roughness, anisotropy or FrameDesc::frame_map off; its textures are not made

    bool names(const std::string& path) const { return !path.empty() && (path == pyramid || path == net); }
};

// Returns an Error whose field is the first that no filter takes.
Status check_mip_settings(const MipSettings& settings);

struct MaterialMips {                           // of one material
    MipFilter filter{};                         // for its normals and lobes
    float kappa = 0.0f;                         // for filter kappa, and for mipnet's taps
    bool coupled = false;                       // base colours and metalness weigh as their texels face light and eye
    bool kaiser = false;                        // they are averaged by ColourKernel::kaiser
    bool gains = false;                         // levels' reflectances are multiplied by their gains
    bool facets = true;                         // a few groups of a strong normal map's facets replace it from afar
    mipnet::Lobe lobe{};                        // of gains
    std::shared_ptr<const mipnet::Weights> net; // for filter mipnet; none: levels are brought along
    std::uint64_t source = 0;                   // MipSource::hash() of its maps and factors; 0: not known yet
};

struct SceneMips {
    std::vector<MaterialMips> materials;   // by scene material; materials beyond its end are filtered by box
    std::shared_ptr<const MipFile> baked;  // levels that were baked beforehand; none: made from the maps
    std::shared_ptr<const MipFile> cached; // the same as are made from the maps, found in the cache or stored there
    bool frames_override = true;           // MipSettings::frames_override

    const MaterialMips& of(std::size_t material) const;
};
extern const SceneMips kBoxMips; // for a scene whose materials are all filtered by box

// Returns the settings' requests for each material. materials: how many. Nets and the gains' lobes are not settled yet.
SceneMips asked_mips(const MipSettings& settings, std::size_t materials);

} // namespace burnish
