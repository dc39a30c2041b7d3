#include "apps/lab/race/opaque_scene.h"

#include <algorithm>
#include <fmt/core.h>
#include <vector>

#include "raster/session/guarded.h"

namespace burnish {
namespace {

bool is_opaque(const Material& m)
{
    return m.transmission <= 0.0f && m.alpha_mode != AlphaMode::blend;
}

// Returns by material whether the tables draw it.
std::vector<bool> drawn_materials(const SceneData& data)
{
    std::vector<bool> drawn(data.scene.materials.size(), false);
    for (const Draw& draw : data.tables.draws)
        drawn[static_cast<std::size_t>(draw.material)] = true;
    return drawn;
}

} // namespace

Result<OpaqueScene> opaque_scene(const std::shared_ptr<const SceneData>& whole)
{
    return guarded(whole->name, [&]() -> Result<OpaqueScene> {
        // Count the materials
        OpaqueScene made{whole};
        const std::vector<bool> drawn = drawn_materials(*whole);
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            made.materials += drawn[i] ? 1 : 0;
            made.left_out += drawn[i] && !is_opaque(whole->scene.materials[i]) ? 1 : 0;
        }
        if (made.left_out == 0)
            return made;
        // Empty their primitives, make them plain, and place the rest
        const auto data = std::make_shared<SceneData>(*whole);
        for (Primitive& primitive : data->scene.primitives)
            if (!is_opaque(data->scene.materials[static_cast<std::size_t>(primitive.material)]))
                primitive.index_count = 0;
        for (Material& m : data->scene.materials)
            if (!is_opaque(m)) {
                Material plain;
                plain.name = m.name;
                m = plain;
            }
        data->tables = make_draw_tables(data->scene);
        data->tables.bounds_min = whole->tables.bounds_min, data->tables.bounds_max = whole->tables.bounds_max;
        made.data = data;
        return made;
    });
}

std::string left_out_note(const OpaqueScene& scene)
{
    if (scene.left_out == 0)
        return "";
    const bool one = scene.left_out == 1;
    return fmt::format("{} of {} materials {}; neither renderer draws {}", scene.left_out, scene.materials,
                       one ? "lets light through or blends" : "let light through or blend", one ? "it" : "them");
}

} // namespace burnish
