// What a command line puts on a scene's materials, as if their file had named it.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/directional_roughness.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

enum class MipFallback { automatic, off }; // automatic: materials are left to closed forms where the net is worse than it may be
inline constexpr float kUsualMipKappa =
    0.7f; // of every model of lobes: makes the least error of the numbers tried (bench/lab/notebook/mip_filters.md)

struct Dress {              // empty: left as it is
    std::string material;   // folder of pictures, whose names end in what they are: see apps/manual/materials.md
    std::string direction;  // an anisotropy texture; materials without strength of anisotropy get 1, which its blue scales
    std::string rotation;   // the same in another encoding
    std::string normal;     // normal map
    std::string quaternion; // the same as quaternions
    std::string height;     // height map, red
    std::string roughness;  // roughness by direction
    RoughnessEncoding roughness_encoding = RoughnessEncoding::widths;
    RotationEncoding rotation_encoding = RotationEncoding::vector;
    bool normal_y_down = false;     // all normal maps have green down
    MipFilter mip_filter{};         // of all materials; the first: as their file has it
    std::optional<float> mip_kappa; // of filters kappa and mipnet; none: kUsualMipKappa
    std::string mip_net;            // weights of `burnish train mip` for filter mipnet; empty: the program's
    int mip_brdf = 0;               // model of lobes that the program's and gains are for, a place of BN_LOBE
    MipFallback mip_fallback{};     // of filter mipnet
    bool gains = false;             // reflectances of levels are multiplied by their gains
    bool couple_albedo = false;     // base colours and metalness of levels weigh as their texels face light and eye
    bool kaiser_colours = false;    // and are averaged by ColourKernel::kaiser
    int threads = 0;                // that make levels; 0: all cores
    bool keep_mips = false;         // levels that take long are looked for in the cache, and kept there
    std::string mip_pyramid;        // levels of `burnish bake mip`
    std::optional<glm::vec3> f0;    // reflectance at normal incidence of all materials, which are dielectrics then

    bool names(const std::string& path) const; // one of its pictures
};

// Pictures lie in the first set of texture coordinates, on every material that something with coordinates wears. Errors: what is no picture
// of its kind, more bytes than textures may have, a scene without texture coordinates; ExitCode::usage: two pictures for one part.
Status dress(Scene& scene, const Dress& with, const Limits& limits);

} // namespace burnish
