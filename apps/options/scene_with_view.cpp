#include "apps/options/scene_with_view.h"

#include <algorithm>

#include "apps/cli/open.h"
#include "apps/options/scene_view.h"

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

void warn_of_missing_behind_glass(const Scene& scene, Report& report)
{
    if (std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.transmission > 0.0f; }))
        report.warning("materials that transmit light show the environment without the objects behind them; "
                       "--backend reference --reference-mode path draws these objects");
}

} // namespace burnish
