#include "raster/session/check_parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "core/scene/check_scene.h"
#include "shading/bake/mipnet/mipnet_fns.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

Error fault(const Environment& environment, const std::string& place, std::string reason)
{
    return {ExitCode::bad_input, environment.name, place, std::move(reason)};
}

Status check_cube(const Environment& e, const CubeMap& cube, const std::string& place)
{
    if (cube.size < 1 || cube.size > 8192 || (cube.size & (cube.size - 1)) != 0)
        return fault(e, place + "/size", fmt::format("{} is no power of two from 1 to 8192", cube.size));
    if (cube.levels < 1 || cube.levels > 14 || (cube.size >> (cube.levels - 1)) == 0)
        return fault(e, place + "/levels", fmt::format("{} levels of a cube of {} texels", cube.levels, cube.size));
    if (cube.offset.size() != static_cast<std::size_t>(cube.levels))
        return fault(e, place + "/offset", fmt::format("holds {} offsets of {} levels", cube.offset.size(), cube.levels));
    std::size_t texels = 0;
    for (int level = 0; level < cube.levels; ++level) {
        if (cube.offset[static_cast<std::size_t>(level)] != texels)
            return fault(e, fmt::format("{}/offset/{}", place, level), fmt::format("is not {}", texels));
        texels += cube.level_texels(level);
    }
    if (cube.texels.size() != 4 * texels)
        return fault(e, place + "/texels", fmt::format("holds {} halves, not {}", cube.texels.size(), 4 * texels));
    if (!std::isfinite(cube.scale) || !(cube.scale > 0.0f))
        return fault(e, place + "/scale", fmt::format("{:g} is not above 0", cube.scale));
    return {};
}

Status check_extracted_light(const Environment& e, std::size_t i)
{
    const ExtractedLight& k = e.extracted_lights[i];
    for (const auto& [numbers, name] : {std::pair(k.direction, "direction"), std::pair(k.axis_u, "axis_u"), std::pair(k.axis_v, "axis_v"),
                                        std::pair(k.irradiance, "irradiance")})
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(numbers[c]))
                return fault(e, fmt::format("/extracted_lights/{}/{}/{}", i, name, c), "is not finite");
    return {};
}

Status check_environment(const Environment& e)
{
    if (!std::isfinite(e.rotation_deg))
        return fault(e, "/rotation_deg", "is not finite");
    const bool picture_only = e.irradiance.texels.empty() && e.specular.texels.empty();
    if (!picture_only)
        BN_TRY(check_cube(e, e.specular, "/specular"));
    if (!e.irradiance.texels.empty())
        BN_TRY(check_cube(e, e.irradiance, "/irradiance"));
    if (!e.extracted_lights.empty() || picture_only)
        BN_TRY(check_cube(e, e.whole, "/whole"));
    if (e.extracted_lights.size() > static_cast<std::size_t>(kMaxExtractedLights))
        return fault(e, "/extracted_lights", fmt::format("{} lights, more than {}", e.extracted_lights.size(), kMaxExtractedLights));
    for (std::size_t i = 0; i < e.extracted_lights.size(); ++i)
        BN_TRY(check_extracted_light(e, i));
    return {};
}

Status check_dfg(const DfgTable& dfg)
{
    const auto size = static_cast<std::size_t>(std::max(dfg.size, 0));
    if (size < 2 || size > 4096)
        return Error{ExitCode::bad_input, "", "/dfg/size", fmt::format("{} lies outside 2 to 4096", dfg.size)};
    if (dfg.pairs.size() != 2 * size * size)
        return Error{ExitCode::bad_input, "", "/dfg/pairs", fmt::format("holds {} numbers, not {}", dfg.pairs.size(), 2 * size * size)};
    return {};
}

Status check_scene_mips(const SceneData& data)
{
    constexpr auto kLastLobe = static_cast<std::uint32_t>(mipnet::Lobe::ashikhmin_shirley);
    for (std::size_t i = 0; i < data.mips.materials.size(); ++i) {
        const MaterialMips& m = data.mips.materials[i];
        const auto wrong = [&](const char* field, std::string reason) {
            return Error{ExitCode::bad_input, data.name, fmt::format("/mips/materials/{}/{}", i, field), std::move(reason)};
        };
        if (static_cast<std::size_t>(m.filter) >= mip_filters().size())
            return wrong("filter", fmt::format("filter {} does not exist", static_cast<int>(m.filter)));
        if (!(m.kappa >= 0.0f && static_cast<double>(m.kappa) <= kMostKappa))
            return wrong("kappa", fmt::format("{:g} lies outside 0 to {:g}", m.kappa, kMostKappa));
        if (static_cast<std::uint32_t>(m.lobe) > kLastLobe)
            return wrong("lobe", fmt::format("lobe {} does not exist", static_cast<std::uint32_t>(m.lobe)));
    }
    return {};
}

} // namespace

Status check_parts(const SessionParts& parts)
{
    Limits any; // file readers have already applied their limits
    any.image_side = std::numeric_limits<int>::max(), any.texture_bytes = std::numeric_limits<std::uint64_t>::max();
    const SceneData& data = *parts.scene;
    BN_TRY(check_scene(data.scene, any, data.name));
    BN_TRY(check_scene_mips(data));
    BN_TRY(check_draw_tables(data.tables, data.scene, data.name));
    BN_TRY(check_environment(*parts.environment));
    return check_dfg(*parts.dfg);
}

} // namespace burnish
