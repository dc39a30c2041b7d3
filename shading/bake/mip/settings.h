// Settings of mip filters for a scene, and the filter of each material.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

enum class MipFallback { automatic, off }; // automatic: materials are left to closed forms where the net is worse than it may be
inline constexpr float kDefaultMipKappa =
    0.7f; // of every model of lobes: makes the least error of the numbers tried (bench/lab/notebook/mip_filters.md)

struct MipSettings {             // of all materials
    MipFilter filter{};          // the first: that of the file of levels, where there is one
    std::optional<float> kappa;  // of filters kappa and mipnet; none: kDefaultMipKappa
    std::string net;             // weights of `burnish train mip` for filter mipnet; empty: the program's
    int brdf = 0;                // model of lobes that the program's and gains are for, a place of BN_LOBE
    MipFallback fallback{};      // of filter mipnet
    bool gains = false;          // reflectances of levels are multiplied by their gains
    bool couple_albedo = false;  // base colours and metalness of levels weigh as their texels face light and eye
    bool kaiser_colours = false; // and are averaged by ColourKernel::kaiser
    std::string pyramid;         // levels of `burnish bake mip`
    int threads = 0;             // that make levels; 0: all cores
    bool use_cache = false;      // levels that take long are looked for in the cache, and kept there
    bool frames_override = true; // false: no frame sets roughness, anisotropy or FrameDesc::frame_map off; its textures are not made

    bool names(const std::string& path) const { return !path.empty() && (path == pyramid || path == net); }
};

// Returns an Error whose field is the first that no filter takes.
Status check_mip_settings(const MipSettings& settings);

struct MaterialMips {                           // of one material
    MipFilter filter{};                         // of its normals and lobes
    float kappa = 0.0f;                         // of filter kappa, and of the taps of mipnet
    bool coupled = false;                       // base colours and metalness weigh as their texels face light and eye
    bool kaiser = false;                        // they are averaged by ColourKernel::kaiser
    bool gains = false;                         // reflectances of levels are multiplied by their gains
    mipnet::Lobe lobe{};                        // of gains
    std::shared_ptr<const mipnet::Weights> net; // of filter mipnet; none: levels are brought along
};

struct SceneMips {
    std::vector<MaterialMips> materials;   // by material of the scene; those beyond its end are filtered by box
    std::shared_ptr<const MipFile> baked;  // levels that were baked beforehand; none: made of the maps
    std::shared_ptr<const MipFile> cached; // the same as are made of the maps, found in the cache or kept there
    bool frames_override = true;           // MipSettings::frames_override

    const MaterialMips& of(std::size_t material) const;
};
extern const SceneMips kBoxMips; // of a scene whose materials are all filtered by box

// Returns what settings ask for each of so many materials. Nets and lobes of gains are not settled yet.
SceneMips asked_mips(const MipSettings& settings, std::size_t materials);

} // namespace burnish
