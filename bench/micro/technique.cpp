// What a fragment costs, by technique, instruction set and threads: 1920x1080, one sample a pixel, every pixel covered by the inside of a
// sphere of alpha_lin 0.3 and eta 0.5 or 0.8 under the studio. ns_fragment is CPU time of the process over fragments: nanoseconds of a core,
// whatever else runs beside it; Time is wall time of a frame.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "core/scene/builtin.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

Scene sphere_around()
{
    constexpr int kRings = 96, kSegments = 192;
    Scene s;
    VertexTable& v = s.vertices;
    for (int j = 0; j <= kRings; ++j)
        for (int i = 0; i <= kSegments; ++i) {
            const double theta = 3.14159265358979 * j / kRings, phi = 2.0 * 3.14159265358979 * i / kSegments;
            const float p[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                                static_cast<float>(std::sin(theta) * std::sin(phi))};
            v.px.push_back(p[0]), v.py.push_back(p[1]), v.pz.push_back(p[2]);
            v.nx.push_back(p[0]), v.ny.push_back(p[1]), v.nz.push_back(p[2]);
            v.tx.push_back(static_cast<float>(-std::sin(phi))), v.ty.push_back(0.0f);
            v.tz.push_back(static_cast<float>(std::cos(phi))), v.tw.push_back(1.0f);
            for (Column<float>* c : {&v.u0, &v.v0, &v.u1, &v.v1})
                c->push_back(0.0f);
            for (Column<float>* c : {&v.cr, &v.cg, &v.cb, &v.ca})
                c->push_back(1.0f);
        }
    for (std::uint32_t j = 0; j < kRings; ++j)
        for (std::uint32_t i = 0; i < kSegments; ++i) {
            const std::uint32_t a = j * (kSegments + 1) + i, b = a + 1, c = a + kSegments + 1, d = c + 1;
            for (std::uint32_t k : {a, b, d, a, d, c})
                s.indices.push_back(k);
        }
    Primitive primitive;
    primitive.index_count = static_cast<std::uint32_t>(s.indices.size());
    primitive.vertex_count = static_cast<std::uint32_t>(v.size());
    s.primitives.push_back(primitive);
    s.meshes.push_back({"sphere", 0, 1});
    Node node;
    node.mesh = 0;
    s.nodes.push_back(node);
    Material material;
    material.double_sided = true;
    s.materials.push_back(material);
    update_world(s);
    return s;
}

struct Stage {
    explicit Stage(int threads)
        : jobs(threads), scene(sphere_around()), tables(make_draw_tables(scene)), dfg(bake_dfg(64, 256, jobs))
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

double process_cpu_ns()
{
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) * 1e9 + static_cast<double>(t.tv_nsec);
}

void run(benchmark::State& state, const std::string& technique, int samples, float eta, Isa isa, int threads)
{
    const Stage& s = stage(threads);
    const std::unique_ptr<Renderer> renderer =
        make_tile_renderer({s.scene, s.tables, s.environment, s.dfg, s.jobs}, isa);
    FrameDesc desc;
    desc.width = 1920, desc.height = 1080, desc.msaa = 1;
    desc.view = make_view({0.1f, 0.2f, 0.0f}, {1.0f, 0.1f, 0.3f}, 1.0f, desc.width, desc.height);
    desc.technique = technique, desc.samples = samples;
    desc.roughness = 0.3f, desc.override_anisotropy = true, desc.anisotropy = eta;
    std::uint64_t fragments = 0;
    double cpu_ns = 0.0;
    Frame last;
    for (auto _ : state) {
        const double begin = process_cpu_ns();
        Result<Frame> frame = renderer->render(desc, std::move(last));
        cpu_ns += process_cpu_ns() - begin;
        state.SetIterationTime(frame->stats.ms * 1e-3);
        fragments += frame->stats.visible_fragments;
        last = std::move(*frame);
    }
    state.counters["ns_fragment"] = cpu_ns / static_cast<double>(fragments);
}

const bool kRegistered = [] {
    for (Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512})
        for (int threads : {1, 2})
            for (const TechniqueInfo& t : techniques()) {
                if (!isa_available(isa) || (isa == Isa::scalar && threads > 1))
                    continue;
                for (const char* eta : {"0.5", "0.8"}) {
                    const std::string name = std::string("technique/") + t.name + "/eta:" + eta + "/" + isa_name(isa) +
                                             "/threads:" + std::to_string(threads);
                    benchmark::RegisterBenchmark(name.c_str(), [&t, eta, isa, threads](benchmark::State& state) {
                        run(state, t.name, t.default_samples, std::strtof(eta, nullptr), isa, threads);
                    })->UseManualTime()->Unit(benchmark::kMillisecond);
                }
            }
    return true;
}();

} // namespace
} // namespace burnish
