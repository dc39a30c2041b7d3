#include "bench/frame/subject.h"

#include <utility>

#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr int kDfgSize = 64, kDfgSamples = 256; // as of `burnish render`
constexpr float kRoughness = 0.3f;              // where a workload overrides eta

// One environment for all. The fine one comes from the cache after the first run.
Result<Environment> bake_studio(bool coarse)
{
    EnvironmentOptions options;
    if (coarse)
        options.cube_size = 64, options.samples = 4, options.use_cache = false;
    return load_environment("builtin:studio", options, Limits{}, Jobs(0));
}
const Result<Environment>& studio(bool coarse)
{
    if (coarse) {
        static const Result<Environment> environment = bake_studio(true);
        return environment;
    }
    static const Result<Environment> environment = bake_studio(false);
    return environment;
}
const DfgTable& dfg(bool coarse)
{
    static const DfgTable table = bake_dfg(kDfgSize, coarse ? 16 : kDfgSamples, Jobs(0));
    return table;
}

class TileSubject final : public Subject {
  public:
    TileSubject(const Workload& w, const SubjectOptions& options, const Environment& environment)
        : jobs_(w.threads ? w.threads : options.threads), scene_(make_bench_scene(w.scene, w.size, w.width, w.height)),
          tables_(make_draw_tables(scene_)),
          renderer_(make_tile_renderer({scene_, tables_, environment, dfg(options.coarse_environment), jobs_}, options.isa)),
          by_triangle_(w.scene == BenchScene::waves)
    {
        desc_.width = w.width, desc_.height = w.height, desc_.msaa = w.msaa;
        desc_.view = bench_view(w.scene, tables_, w.width, w.height);
        desc_.technique = w.technique;
        desc_.samples = w.samples ? w.samples : find_technique(w.technique)->default_samples;
        if (w.eta != 0.0f)
            desc_.roughness = kRoughness, desc_.override_anisotropy = true, desc_.anisotropy = w.eta;
    }
    void frame() override { last_ = draw(desc_, std::move(last_)); }
    double units() const override
    {
        return by_triangle_ ? static_cast<double>(tables_.triangle_count()) : static_cast<double>(desc_.width) * desc_.height;
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
        Result<Frame> frame = renderer_->render(desc, std::move(recycled));
        return frame ? std::move(*frame) : Frame{};
    }
    Jobs jobs_;
    Scene scene_;
    DrawTables tables_;
    std::unique_ptr<Renderer> renderer_;
    bool by_triangle_;
    FrameDesc desc_;
    Frame last_; // its memory is the next one's
    Column<std::uint32_t> ids_;
};

} // namespace

Result<std::unique_ptr<Subject>> make_subject(const Workload& workload, const SubjectOptions& options)
{
    if (workload.engine == Engine::rays)
        return make_ray_subject(workload, options);
    const Result<Environment>& environment = studio(options.coarse_environment);
    if (!environment)
        return environment.error();
    return std::unique_ptr<Subject>(std::make_unique<TileSubject>(workload, options, *environment));
}

} // namespace burnish
