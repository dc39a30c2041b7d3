#include "apps/options/scene_with_view.h"

#include "apps/cli/open.h"
#include "apps/options/scene_view.h"
#include "raster/frame/bodies.h"

namespace burnish {

Result<SceneWithView> load_scene_with_view(const std::string& name, const RenderOptions& base, Report& report, const Jobs& jobs)
{
    const Result<std::shared_ptr<const SceneData>> data =
        open_scene(name, base.limits, base.overrides, base.mips, base.moment, base.lights, {}, &jobs);
    BN_TRY(data);
    for (const std::string& warning : (*data)->scene.warnings)
        report.warning(warning);
    RenderOptions options = base;
    options.scene = name;
    const Result<ChosenView> view = choose_view(options, (*data)->scene, (*data)->tables);
    BN_TRY(view);
    return SceneWithView{*data, view->view};
}

void warn_of_glass(const SceneData& data, Report& report)
{
    const Scene& scene = data.scene;
    const Material *glass = nullptr, *blended = nullptr;
    for (std::uint32_t id : data.tables.triangle_material) {
        const Material& m = scene.materials[id];
        if (m.transmission > 0.0f)
            glass = &m;
        else if (m.alpha_mode == AlphaMode::blend)
            blended = &m;
    }
    if (glass && blended)
        report.warning(material_text(scene, *blended) + " is blended: glass (" + material_text(scene, *glass) +
                       ") does not show it behind itself");
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        const bool volume = m.transmission > 0.0f && (m.thickness > 0.0f || m.attenuation_distance > 0.0f);
        if (volume && !is_closed_body(data.tables, i))
            report.warning(material_text(scene, m) + " has a volume on an open mesh: drawn as a thin sheet, which absorbs nothing");
    }
}

} // namespace burnish
