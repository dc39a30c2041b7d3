// Cost of a fragment by technique, instruction set and threads. 1920x1080, one sample a pixel; the inside of a sphere
// with roughness 0.3 and eta 0.5 or 0.8, under the studio, covers every pixel. ns_fragment is the process's CPU time
// over fragments: nanoseconds on one core, independent of other load. Time is a frame's wall time.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>
#include <string>

#include "bench/scenes/figures.h"
#include "bench/scenes/scenes.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Stage {
    explicit Stage(int threads)
        : jobs(threads), scene(make_bench_scene(BenchScene::sphere, 0, kWidth, kHeight)), tables(make_draw_tables(scene)),
          dfg(bake_dfg(64, 256, jobs))
    {
        EnvironmentOptions options;
        options.samples = 256;
        Result<Environment> baked = load_environment("builtin:studio", options, Limits{}, jobs);
        if (baked)
            environment = std::move(*baked);
    }
    Jobs jobs;
    Scene scene;
    DrawTables tables;
    DfgTable dfg;
    Environment environment;
};

const Stage& stage(int threads)
{
    static std::map<int, Stage> stages;
    return stages.try_emplace(threads, threads).first->second;
}

void run(benchmark::State& state, const std::string& technique, int samples, float eta, Isa isa, int threads)
{
    const Stage& s = stage(threads);
    const std::unique_ptr<Renderer> renderer = make_tile_renderer({s.scene, s.tables, s.environment, s.dfg, s.jobs}, isa);
    FrameDesc desc;
    desc.width = kWidth, desc.height = kHeight, desc.msaa = 1;
    desc.view = bench_view(BenchScene::sphere, s.tables, kWidth, kHeight);
    desc.technique = technique, desc.samples = samples;
    desc.roughness = 0.3f, desc.override_anisotropy = true, desc.anisotropy = eta;
    std::uint64_t fragments = 0;
    double cpu_ns = 0.0;
    Frame last;
    for (auto _ : state) {
        const double begin = process_cpu_ms();
        Result<Frame> frame = renderer->render(desc, std::move(last));
        cpu_ns += (process_cpu_ms() - begin) * 1e6;
        state.SetIterationTime(frame->stats.ms * 1e-3);
        fragments += frame->stats.visible_fragments;
        last = std::move(*frame);
    }
    state.counters["ns_fragment"] = cpu_ns / static_cast<double>(fragments);
}

const bool kRegistered = [] {
    for (Isa isa : program_isas())
        for (int threads : {1, 2})
            for (const TechniqueInfo& t : techniques()) {
                if (!isa_available(isa) || (isa == Isa::scalar && threads > 1))
                    continue;
                for (const char* eta : {"0.5", "0.8"}) {
                    const std::string name =
                        std::string("technique/") + t.name + "/eta:" + eta + "/" + isa_name(isa) + "/threads:" + std::to_string(threads);
                    benchmark::RegisterBenchmark(name.c_str(),
                                                 [&t, eta, isa, threads](benchmark::State& state) {
                                                     run(state, t.name, t.default_samples, std::strtof(eta, nullptr), isa, threads);
                                                 })
                        ->UseManualTime()
                        ->Unit(benchmark::kMillisecond);
                }
            }
    return true;
}();

} // namespace
} // namespace burnish
