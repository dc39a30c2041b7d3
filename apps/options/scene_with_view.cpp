#include "apps/options/scene_with_view.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/open.h"
#include "apps/options/scene_view.h"
#include "shading/lang/records.h"

namespace burnish {

Result<SceneWithView> load_scene_with_view(const std::string& name, const RenderOptions& base, Report& report)
{
    const Result<std::shared_ptr<const SceneData>> data =
        open_scene(name, base.limits, base.overrides, base.mips, base.moment, base.lights);
    BN_TRY(data);
    for (const std::string& warning : (*data)->scene.warnings)
        report.warning(warning);
    RenderOptions options = base;
    options.scene = name;
    const Result<ChosenView> view = choose_view(options, (*data)->scene, (*data)->tables);
    BN_TRY(view);
    return SceneWithView{*data, view->view};
}

void warn_of_opaque_glass(const Scene& scene, const std::vector<std::string>& techniques, Report& report)
{
    if (std::none_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.transmission > 0.0f; }))
        return;
    std::vector<std::string> opaque;
    for (const std::string& name : techniques)
        if (!(find_technique(name)->traits & kRefracts))
            opaque.push_back(name);
    if (!opaque.empty())
        report.warning(
            fmt::format("materials that let light through are drawn opaque by {}; mc and the reference refract it", join(opaque)));
}

} // namespace burnish
