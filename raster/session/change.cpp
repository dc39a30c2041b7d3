// Changes to a session's scene between frames.
#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "core/jobs/activity.h"
#include "core/scene/check_scene.h"
#include "raster/frame/mip_files.h"
#include "raster/frame/pyramids.h"
#include "raster/session/check_parts.h"
#include "raster/session/guarded.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

// Swaps each change with the scene's own value, from the first to the last or backwards. A second swap in the other order restores the
// scene.
void swap_in(Scene& scene, SceneChanges& changes, bool backwards)
{
    const auto swap_all = [&](auto& list, const auto& swap_one) {
        if (backwards)
            std::for_each(list.rbegin(), list.rend(), swap_one);
        else
            std::for_each(list.begin(), list.end(), swap_one);
    };
    const auto at = [](std::int32_t index) { return static_cast<std::size_t>(index); };
    swap_all(changes.nodes, [&](auto& c) { std::swap(scene.nodes[at(c.first)].local, c.second); });
    swap_all(changes.materials, [&](auto& c) { std::swap(scene.materials[at(c.first)], c.second); });
    swap_all(changes.primitives, [&](auto& c) { std::swap(scene.primitives[at(c.first)].material, c.second); });
    swap_all(changes.lights, [&](auto& c) { std::swap(scene.lights[at(c.first)], c.second); });
}

bool same_map(const TextureRef& a, const TextureRef& b)
{
    return a.texture == b.texture && a.uv_set == b.uv_set && a.uv_transform == b.uv_transform;
}

// Returns the first map that differs between the materials, or null.
const char* differing_map(const Material& a, const Material& b)
{
#define BN_TEXTURE(name, path)                                                                                                             \
    if (!same_map(a.name, b.name))                                                                                                         \
        return #name;
#include "core/scene/material.def"
    return nullptr;
}

// Returns by node whether the node or one below has an area light, or a mesh that shows one.
std::vector<bool> with_area_lights(const Scene& scene)
{
    const auto shows_light = [&](const Mesh& mesh) {
        for (std::uint32_t k = 0; k < mesh.primitive_count; ++k)
            if (scene.materials[static_cast<std::size_t>(scene.primitives[mesh.first_primitive + k].material)].emitter != kNoEmitter)
                return true;
        return false;
    };
    std::vector<bool> lit(scene.nodes.size(), false);
    for (std::size_t i = lit.size(); i-- > 0;) { // children come after their parents
        const Node& node = scene.nodes[i];
        lit[i] =
            lit[i] || node.area_light != kNone || (node.mesh != kNone && shows_light(scene.meshes[static_cast<std::size_t>(node.mesh)]));
        if (lit[i] && node.parent != kNone)
            lit[static_cast<std::size_t>(node.parent)] = true;
    }
    return lit;
}

Status check_changes(const SceneData& data, const SceneChanges& changes)
{
    const Scene& scene = data.scene;
    const auto wrong = [&](ExitCode code, std::string place, std::string reason) {
        return Error{code, data.name, std::move(place), std::move(reason)};
    };
    const auto material_of = [&](std::int32_t index) -> const Material& { return scene.materials[static_cast<std::size_t>(index)]; };
    // Indices
    const auto check = [&](const char* table, const auto& list, std::size_t size) -> Status {
        for (const auto& change : list)
            if (change.first < 0 || static_cast<std::size_t>(change.first) >= size)
                return wrong(ExitCode::bad_input, fmt::format("/{}/{}", table, change.first), fmt::format("the scene has {}", size));
        return {};
    };
    BN_TRY(check("nodes", changes.nodes, scene.nodes.size()));
    BN_TRY(check("materials", changes.materials, scene.materials.size()));
    BN_TRY(check("primitives", changes.primitives, scene.primitives.size()));
    BN_TRY(check("lights", changes.lights, scene.lights.size()));
    // Changes that need a new session
    const bool of_surfaces = !changes.nodes.empty() || !changes.materials.empty() || !changes.primitives.empty();
    if (of_surfaces && std::any_of(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.stage; }))
        return wrong(ExitCode::usage, "", "the floor's contact shadows belong to the scene as it was opened: open it without a floor");
    if (!changes.materials.empty() && data.mips.baked)
        return wrong(ExitCode::usage, "/materials", "their levels were made beforehand, for the materials as they were opened");
    for (const auto& [index, material] : changes.materials)
        if (const char* map = differing_map(material, material_of(index)))
            return wrong(ExitCode::usage, fmt::format("/materials/{}/{}", index, map), "maps stay as they were opened; factors may change");
    for (const auto& [index, light] : changes.lights)
        if (!data.visibility.empty() && light.type != scene.lights[static_cast<std::size_t>(index)].type)
            return wrong(ExitCode::usage, fmt::format("/lights/{}/type", index), "the floor's contact shadows depend on it");
    // The shapes that show area lights stay in place
    const char* const kShape = "an area light's shape stays as it was opened: make a new session";
    const std::vector<bool> lit = with_area_lights(scene);
    for (const auto& [index, local] : changes.nodes)
        if (lit[static_cast<std::size_t>(index)])
            return wrong(ExitCode::usage, fmt::format("/nodes/{}", index), kShape);
    for (const auto& [index, material] : changes.materials)
        if (material_of(index).emitter != kNoEmitter)
            return wrong(ExitCode::usage, fmt::format("/materials/{}", index), kShape);
    for (const auto& [index, material] : changes.primitives) {
        const bool known = material >= 0 && static_cast<std::size_t>(material) < scene.materials.size(); // else check_scene() says so
        if (material_of(scene.primitives[static_cast<std::size_t>(index)].material).emitter != kNoEmitter ||
            (known && material_of(material).emitter != kNoEmitter))
            return wrong(ExitCode::usage, fmt::format("/primitives/{}/material", index), kShape);
    }
    return {};
}

// Changes of a scene that are undone at the object's end, unless stay() is called. Undoing allocates nothing.
class Applied {
  public:
    Applied(SceneData& data, SceneChanges& changes)
        : data_(data), changes_(changes), mips_(data.mips), warnings_(data.scene.warnings.size())
    {
        for (const Node& node : data.scene.nodes)
            worlds_.push_back(node.world);
        for (const auto& [index, local] : changes.nodes)
            beyond_.push_back(data.scene.nodes[static_cast<std::size_t>(index)].local_beyond);
        for (const auto& [index, local] : changes.nodes)
            data.scene.nodes[static_cast<std::size_t>(index)].local_beyond = glm::dvec3(0.0);
        swap_in(data.scene, changes, false);
        tables_ = std::move(data.tables);
    }
    ~Applied()
    {
        if (stays_)
            return;
        Scene& scene = data_.scene;
        swap_in(scene, changes_, true);
        for (std::size_t i = 0; i < beyond_.size(); ++i)
            scene.nodes[static_cast<std::size_t>(changes_.nodes[i].first)].local_beyond = beyond_[i];
        for (std::size_t i = 0; i < worlds_.size(); ++i)
            scene.nodes[i].world = worlds_[i];
        scene.warnings.erase(scene.warnings.begin() + static_cast<std::ptrdiff_t>(warnings_), scene.warnings.end());
        data_.tables = std::move(tables_), data_.mips = std::move(mips_);
    }
    Applied(const Applied&) = delete;
    Applied& operator=(const Applied&) = delete;
    // Keeps the changes. Warnings that the scene had already are dropped.
    void stay()
    {
        stays_ = true;
        std::vector<std::string>& all = data_.scene.warnings;
        const auto fresh = all.begin() + static_cast<std::ptrdiff_t>(warnings_);
        all.erase(std::remove_if(fresh, all.end(), [&](const std::string& text) { return std::find(all.begin(), fresh, text) != fresh; }),
                  all.end());
    }

  private:
    SceneData& data_;
    SceneChanges& changes_;
    std::vector<glm::mat4> worlds_;  // of all nodes
    std::vector<glm::dvec3> beyond_; // Node::local_beyond of the changed nodes
    DrawTables tables_{};
    SceneMips mips_;
    std::size_t warnings_;
    bool stays_ = false;
};

// Warns of materials that became anisotropic, on primitives without coordinates and tangents. changes: hold what was before.
void warn_of_directions(Scene& scene, const SceneChanges& changes)
{
    const auto changed = [](const auto& list, std::size_t index) {
        return std::any_of(list.begin(), list.end(), [&](const auto& change) { return static_cast<std::size_t>(change.first) == index; });
    };
    const auto was_anisotropic = [&](std::size_t primitive, std::size_t material) {
        for (const auto& [index, before] : changes.primitives)
            if (static_cast<std::size_t>(index) == primitive)
                material = static_cast<std::size_t>(before);
        for (const auto& [index, before] : changes.materials)
            if (static_cast<std::size_t>(index) == material)
                return before.anisotropy_strength > 0.0f;
        return scene.materials[material].anisotropy_strength > 0.0f && changed(changes.primitives, primitive);
    };
    const VertexTable& v = scene.vertices;
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
        const Primitive& p = scene.primitives[i];
        const auto material = static_cast<std::size_t>(p.material);
        if ((!changed(changes.materials, material) && !changed(changes.primitives, i)) || p.has_uv0 || p.vertex_count == 0 ||
            !(scene.materials[material].anisotropy_strength > 0.0f) || was_anisotropic(i, material))
            continue;
        if (v.tx[p.first_vertex] == 0.0f && v.ty[p.first_vertex] == 0.0f && v.tz[p.first_vertex] == 0.0f)
            scene.warnings.push_back(fmt::format("/primitives/{}: anisotropy needs coordinates, since the highlight runs along their first "
                                                 "axis: the direction is arbitrary",
                                                 i));
    }
}

// Makes everything that depends on the scene's tables.
Status settle(SceneData& data, const SceneChanges& changes)
{
    Limits any; // file readers have already applied their limits
    any.image_side = std::numeric_limits<int>::max(), any.texture_bytes = std::numeric_limits<std::uint64_t>::max();
    update_world(data.scene);
    BN_TRY(check_scene(data.scene, any, data.name));
    data.tables = make_draw_tables(data.scene);
    darken_vertices(data.tables, data.visibility);
    BN_TRY(check_draw_range(data.scene, data.tables, data.name));
    warn_of_directions(data.scene, changes);
    if (changes.materials.empty())
        return {};
    SceneMips asked = asked_mips(data.asked, data.scene.materials.size());
    asked.materials.resize(data.scene.materials.size());
    std::vector<bool> changed(data.scene.materials.size(), false);
    for (const auto& [index, material] : changes.materials) {
        const auto i = static_cast<std::size_t>(index);
        changed[i] = true, data.mips.materials[i] = asked.materials[i];
    }
    return settle_nets(data.scene, data.mips, data.asked, any, &changed);
}

} // namespace

Status Session::change(SceneChanges changes)
{
    if (!renderer_)
        return moved_away();
    return guarded(parts_.scene->name, [&]() -> Status {
        const Activity activity("changing the scene");
        BN_TRY(check_changes(*parts_.scene, changes));
        SessionParts parts = parts_;
        if (changes.environment)
            parts.environment = changes.environment;
        auto pyramids = std::make_shared<PyramidCache>(*pyramids_);
        if (changes.nodes.empty() && changes.materials.empty() && changes.primitives.empty() && changes.lights.empty()) {
            Result<Session> next = make_with(std::move(parts), options_, std::move(pyramids));
            BN_TRY(next);
            *this = std::move(*next);
            return {};
        }
        for (auto& [index, material] : changes.materials) {
            const Material& old = parts.scene->scene.materials[static_cast<std::size_t>(index)];
            material.emitter = old.emitter, material.has_height_map = old.has_height_map; // these belong to area lights and maps
            pyramids->forget_material(index);
        }
        const bool shared = parts_.scene.use_count() > 2;    // by others than parts_ and parts
        std::atomic_thread_fence(std::memory_order_acquire); // other threads' last reads come before
        // Scene data are objects that were not made const (make_scene_data())
        const auto data = shared ? std::make_shared<SceneData>(*parts_.scene) : std::const_pointer_cast<SceneData>(parts.scene);
        parts.scene = data;
        Applied applied(*data, changes);
        BN_TRY(settle(*data, changes));
        Result<Session> next = make_with(std::move(parts), options_, std::move(pyramids));
        BN_TRY(next);
        *this = std::move(*next);
        applied.stay();
        return {};
    });
}

} // namespace burnish
