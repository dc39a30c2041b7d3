#include "bench/frame/subject.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "core/base/check.h"
#include "core/base/result.h"
#include "core/scene/area_light.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

// Bakes the environment that all workloads share. The fine one comes from the cache after the first run.
Result<std::shared_ptr<const Environment>> bake_studio(bool coarse)
{
    EnvironmentOptions options;
    if (coarse)
        options.cube_size = 64, options.samples = 4, options.use_cache = false;
    return load_shared_environment("builtin:studio", options, Limits{}, Jobs(0));
}
const Result<std::shared_ptr<const Environment>>& studio(bool coarse)
{
    if (coarse) {
        static const auto environment = bake_studio(true);
        return environment;
    }
    static const auto environment = bake_studio(false);
    return environment;
}
std::shared_ptr<const DfgTable> dfg(bool coarse)
{
    if (!coarse)
        return *standard_dfg(Jobs(0));
    static const auto table = std::make_shared<const DfgTable>(bake_dfg(kDfgSize, 16, Jobs(0)));
    return table;
}

// Adds suns one degree wide, side by side. The environment's image stays unchanged.
std::shared_ptr<const Environment> with_extracted_lights(const Environment& environment, int count)
{
    auto lit = std::make_shared<Environment>(environment);
    lit->extracted_lights.clear();
    for (int i = 0; i < count; ++i) {
        const float turn = static_cast<float>(i), radius = 0.00873f;
        lit->extracted_lights.push_back({{0.6f * std::cos(turn), 0.8f, 0.6f * std::sin(turn)},
                                         {radius * -std::sin(turn), 0.0f, radius * std::cos(turn)},
                                         {radius * 0.8f * std::cos(turn), radius * -0.6f, radius * 0.8f * std::sin(turn)},
                                         {3.0f, 2.0f, 1.0f},
                                         radius,
                                         0.1f});
    }
    lit->whole = lit->specular;
    return lit;
}

// Adds quads in rows of at most eight behind the eye of bench_view(sphere), where no pixel shows them.
void add_quads(Scene& scene, int count)
{
    const int across = std::clamp(count, 1, 8), rows = (count + across - 1) / across;
    for (int i = 0; i < count; ++i) {
        const float y = 0.2f + 0.12f * (static_cast<float>(i / across) - 0.5f * static_cast<float>(rows - 1)),
                    z = 0.12f * (static_cast<float>(i % across) - 0.5f * static_cast<float>(across - 1)), h = 0.04f;
        AreaLight light;
        light.points = {{-0.5f, y - h, z - h}, {-0.5f, y - h, z + h}, {-0.5f, y + h, z + h}, {-0.5f, y + h, z - h}};
        light.radiance = glm::vec3(3.0f, 2.0f, 1.0f), light.two_sided = true;
        add_area_light(scene, light);
    }
}

int way_named(std::string_view name)
{
    for (std::size_t i = 0; i < area_ways().size(); ++i)
        if (name == area_ways()[i].name)
            return static_cast<int>(i);
    BN_CHECK(!"a way of area lights by this name");
    return 0;
}

class TileSubject final : public Subject {
  public:
    TileSubject(const Workload& w, Session session) : session_(std::move(session)), by_triangle_(w.scene == BenchScene::waves)
    {
        desc_.width = w.width, desc_.height = w.height, desc_.msaa = w.msaa;
        desc_.view = bench_view(w.scene, session_.tables(), w.width, w.height);
        desc_.technique = w.technique;
        desc_.samples = w.samples ? w.samples : find_technique(w.technique)->default_samples;
        desc_.frame_map = w.frame_map, desc_.area_way = way_named(w.area_way);
        desc_.light_samples = static_cast<std::uint32_t>(w.light_samples);
        desc_.background = w.background;
        if (w.eta != 0.0f)
            desc_.roughness = w.roughness, desc_.override_anisotropy = true, desc_.anisotropy = w.eta;
    }
    void frame() override { last_ = draw(desc_, std::move(last_)); }
    std::string pixels() const override { return fmt::format("{:016x}", pixel_hash(last_.color)); }
    double units() const override
    {
        return by_triangle_ ? static_cast<double>(session_.tables().triangle_count()) : static_cast<double>(desc_.width) * desc_.height;
    }
    const Column<std::uint32_t>& triangle_ids() override
    {
        FrameDesc desc = desc_;
        desc.triangle_ids = true;
        ids_ = draw(desc, {}).triangle_ids;
        return ids_;
    }

  private:
    Frame draw(const FrameDesc& desc, Frame recycled)
    {
        Result<Frame> frame = session_.render_any(desc, std::move(recycled));
        return frame ? std::move(*frame) : Frame{};
    }
    Session session_;
    bool by_triangle_;
    FrameDesc desc_;
    Frame last_; // the next frame reuses its memory
    Column<std::uint32_t> ids_;
};

} // namespace

Result<std::unique_ptr<Subject>> make_subject(const Workload& workload, const SubjectOptions& options)
{
    if (workload.engine == Engine::rays)
        return make_ray_subject(workload, options);
    const Result<std::shared_ptr<const Environment>>& environment = studio(options.coarse_environment);
    BN_TRY(environment);
    const Workload& w = workload;
    Scene made = make_bench_scene(w.scene, w.size, w.width, w.height);
    add_quads(made, w.quads);
    const Result<std::shared_ptr<const SceneData>> scene = make_scene_data(w.name, std::move(made), Limits{});
    BN_TRY(scene);
    SessionOptions tile;
    tile.isa = options.isa;
    const auto jobs = std::make_shared<const Jobs>(w.threads ? w.threads : options.threads);
    const std::shared_ptr<const Environment> light =
        w.extracted_lights ? with_extracted_lights(**environment, w.extracted_lights) : *environment;
    Result<Session> session = Session::make({*scene, light, jobs, dfg(options.coarse_environment)}, tile);
    BN_TRY(session);
    return std::unique_ptr<Subject>(std::make_unique<TileSubject>(w, std::move(*session)));
}

} // namespace burnish
