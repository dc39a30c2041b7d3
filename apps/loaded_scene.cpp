#include "apps/loaded_scene.h"

#include "apps/scene_view.h"
#include "core/scene/gltf.h"

namespace burnish {

Result<std::unique_ptr<LoadedScene>> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report)
{
    auto loaded = std::make_unique<LoadedScene>();
    Result<Scene> scene = load_scene(name, base.limits);
    if (!scene)
        return scene.error();
    loaded->name = name;
    loaded->scene = std::move(*scene);
    update_world(loaded->scene);
    if (const Status size = check_draw_size(loaded->scene, base.limits, name); !size)
        return size.error();
    loaded->tables = make_draw_tables(loaded->scene);
    for (const std::string& warning : loaded->scene.warnings)
        report.warning(warning);
    RenderOptions options = base;
    options.scene = name;
    const Result<ChosenView> view = choose_view(options, loaded->scene, loaded->tables);
    if (!view)
        return view.error();
    loaded->view = view->view;
    return loaded;
}

} // namespace burnish
