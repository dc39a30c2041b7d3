#include "apps/cli/seen_scene.h"

#include "apps/cli/open.h"
#include "apps/cli/scene_view.h"

namespace burnish {

Result<SeenScene> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report)
{
    const Result<std::shared_ptr<const SceneData>> data = open_scene(name, base.limits, base.direction_map, base.moment);
    if (!data)
        return data.error();
    for (const std::string& warning : (*data)->scene.warnings)
        report.warning(warning);
    RenderOptions options = base;
    options.scene = name;
    const Result<ChosenView> view = choose_view(options, (*data)->scene, (*data)->tables);
    if (!view)
        return view.error();
    return SeenScene{*data, view->view};
}

} // namespace burnish
