#include "shading/bake/mip/settings.h"

#include <fmt/format.h>

#include "shading/lang/records.h"

namespace burnish {

const SceneMips kBoxMips;

Status check_mip_settings(const MipSettings& settings)
{
    const auto wrong = [](const char* field, std::string reason) { return Error{ExitCode::usage, "", "", std::move(reason), field}; };
    if (static_cast<std::size_t>(settings.filter) >= mip_filters().size())
        return wrong("MipSettings::filter", fmt::format("filter {} does not exist", static_cast<int>(settings.filter)));
    if (settings.kappa && !(*settings.kappa >= 0.0f && static_cast<double>(*settings.kappa) <= kMostKappa))
        return wrong("MipSettings::kappa", fmt::format("{:g} lies outside 0 to {:g}", *settings.kappa, kMostKappa));
    if (settings.brdf < 0 || settings.brdf >= kLobeCount)
        return wrong("MipSettings::brdf", fmt::format("lobe {} does not exist", settings.brdf));
    return {};
}

const MaterialMips& SceneMips::of(std::size_t material) const
{
    static const MaterialMips by_box;
    return material < materials.size() ? materials[material] : by_box;
}

SceneMips asked_mips(const MipSettings& settings, std::size_t materials)
{
    MaterialMips each;
    if (settings.filter != MipFilter{})
        each.filter = settings.filter, each.kappa = settings.kappa.value_or(kDefaultMipKappa);
    each.gains = settings.gains, each.coupled = settings.couple_albedo, each.kaiser = settings.kaiser_colours;
    each.facets = settings.facets;
    return {std::vector<MaterialMips>(materials, each), nullptr, nullptr, settings.frames_override};
}

} // namespace burnish
