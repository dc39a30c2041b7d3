// Cost of each stage before shading, from profiled frames on one thread: vertices, triangle setup, bins, edge tests and
// depth, fragment lists, resolve. Varies instruction set, samples and triangle size. Time is the stage's time in one
// frame.
#include <benchmark/benchmark.h>
#include <map>
#include <memory>
#include <string>

#include "bench/scenes/scenes.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr int kWidth = 960, kHeight = 540;

struct Sheet { // triangles of about `pixels` pixels each over the whole image
    explicit Sheet(int pixels)
        : scene(make_bench_scene(BenchScene::waves, kWidth * kHeight / pixels, kWidth, kHeight)), tables(make_draw_tables(scene))
    {
        EnvironmentOptions options;
        options.cube_size = 16, options.samples = 1, options.use_cache = false;
        if (Result<Environment> baked = load_environment("builtin:sky", options, Limits{}, jobs))
            environment = std::move(*baked);
        dfg = bake_dfg(16, 4, jobs);
    }
    Jobs jobs{1};
    Scene scene;
    DrawTables tables;
    Environment environment;
    DfgTable dfg;
};

const Sheet& sheet(int pixels)
{
    static std::map<int, Sheet> sheets;
    return sheets.try_emplace(pixels, pixels).first->second;
}

enum class Unit { vertex, triangle, pixel };

void run(benchmark::State& state, FrameStage stage, Unit unit, int pixels, int msaa, Isa isa)
{
    const Sheet& s = sheet(pixels);
    const std::unique_ptr<Renderer> renderer = make_tile_renderer({s.scene, s.tables, s.environment, s.dfg, s.jobs}, isa);
    FrameDesc desc;
    desc.width = kWidth, desc.height = kHeight, desc.msaa = msaa, desc.profile = true;
    desc.view = bench_view(BenchScene::waves, s.tables, kWidth, kHeight);
    double seconds = 0.0;
    Frame last;
    for (auto _ : state) {
        Result<Frame> frame = renderer->render(desc, std::move(last));
        const double taken = static_cast<double>(frame->profile.stage_ns[static_cast<std::size_t>(stage)]) * 1e-9;
        state.SetIterationTime(taken);
        seconds += taken;
        last = std::move(*frame);
    }
    const double units = unit == Unit::vertex     ? static_cast<double>(s.tables.px.size())
                         : unit == Unit::triangle ? static_cast<double>(s.tables.triangle_count())
                                                  : static_cast<double>(kWidth) * kHeight;
    state.counters[unit == Unit::vertex     ? "ns_vertex"
                   : unit == Unit::triangle ? "ns_triangle"
                                            : "ns_pixel"] = seconds * 1e9 / (units * static_cast<double>(state.iterations()));
}

struct Case {
    FrameStage stage;
    Unit unit;
    bool by_samples;
};
constexpr Case kCases[] = {
    {FrameStage::transform, Unit::vertex, false}, {FrameStage::setup, Unit::triangle, false},   {FrameStage::bin, Unit::triangle, false},
    {FrameStage::gather, Unit::triangle, false},  {FrameStage::coverage, Unit::triangle, true}, {FrameStage::clear, Unit::pixel, true},
    {FrameStage::visibility, Unit::pixel, true},  {FrameStage::resolve, Unit::pixel, true},
};

const bool kRegistered = [] {
    for (Isa isa : program_isas())
        for (const Case& c : kCases)
            for (int pixels : {2, 32, 2048})
                for (int msaa : {1, 4, 8}) {
                    if (!isa_available(isa) || (msaa > 1 && !c.by_samples))
                        continue;
                    const std::string name = std::string("stage/") + kFrameStageNames[static_cast<std::size_t>(c.stage)] +
                                             "/triangle_pixels:" + std::to_string(pixels) + "/msaa:" + std::to_string(msaa) + "/" +
                                             isa_name(isa);
                    benchmark::RegisterBenchmark(name.c_str(),
                                                 [=](benchmark::State& state) { run(state, c.stage, c.unit, pixels, msaa, isa); })
                        ->UseManualTime()
                        ->Unit(benchmark::kMicrosecond)
                        ->Iterations(10); // a time limit would draw a short stage for minutes
                }
    return true;
}();

} // namespace
} // namespace burnish
