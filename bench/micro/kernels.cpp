// Cost of each technique's kernel, for each instruction set, on reflections as seen on a screen. Measures time for each
// fragment. The counting build of the same code gives floating-point operations and bytes for each fragment.
#include <benchmark/benchmark.h>
#include <cmath>
#include <string>
#include <vector>

#include "bench/micro/kernels.h"
#include "raster/frame/frame_record.h"
#include "raster/frame/grid_samples.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr int kWidth = 256, kHeight = 144, kCount = kWidth * kHeight;
constexpr float kAlpha = 0.09f; // for a roughness of 0.3

struct Surfaces {
    std::vector<float> values[9];
    KernelSurfaces of(float eta) const
    {
        KernelSurfaces s = {};
        for (int k = 0; k < 3; ++k)
            s.n[k] = values[k].data(), s.v[k] = values[3 + k].data(), s.t[k] = values[6 + k].data();
        s.count = kCount;
        s.sigma_u = kAlpha * (1.0f + eta) * 0.70710678f, s.sigma_v = kAlpha * (1.0f - eta) * 0.70710678f;
        return s;
    }
};

// Surfaces of a unit sphere seen from its centre, in image rows and columns.
const Surfaces& surfaces()
{
    static const Surfaces made = [] {
        Surfaces s;
        for (int i = 0; i < kCount; ++i) {
            const double x = (i % kWidth + 0.5) / kWidth * 2.0 - 1.0, y = 1.0 - (i / kWidth + 0.5) / kHeight * 2.0;
            glm::dvec3 ray = glm::normalize(glm::dvec3(1.0, 0.6 * y, 1.0 * x)), eye(0.1, 0.2, 0.0);
            const double b = glm::dot(eye, ray), far = -b + std::sqrt(b * b - glm::dot(eye, eye) + 1.0);
            const glm::dvec3 n = -(eye + ray * far), t = glm::normalize(glm::dvec3(-n.z, 0.0, n.x));
            for (int k = 0; k < 3; ++k) {
                s.values[k].push_back(static_cast<float>(n[k]));
                s.values[3 + k].push_back(static_cast<float>(-ray[k]));
                s.values[6 + k].push_back(static_cast<float>(t[k]));
            }
        }
        return s;
    }();
    return made;
}

struct Studio {
    Environment environment;
    CubeMap box;
};
const Studio& studio()
{
    static const Studio made = [] {
        const Jobs jobs(0);
        Studio s;
        EnvironmentOptions options;
        options.samples = 256;
        if (Result<Environment> baked = load_environment("builtin:studio", options, Limits{}, jobs))
            s.environment = std::move(*baked);
        s.box = box_filtered_chain(s.environment.specular, jobs);
        return s;
    }();
    return made;
}

void run(benchmark::State& state, std::size_t technique, float eta, Isa isa)
{
    const TechniqueInfo& info = techniques()[technique];
    FrameParams f = {};
    const CubeMap &specular = studio().environment.specular, &box = studio().box;
    f.specular = cube_record(specular), f.specular_texels = specular.texels.data();
    f.box = cube_record(box), f.box_texels = box.texels.data();
    const std::vector<GridSample> grid = grid_samples(info.default_samples, info.sampling, info.traits);
    f.grid = grid.data(), f.grid_count = grid_count(grid, info.traits);
    put_parameters(FrameDesc{}, false, f);
    KernelSurfaces in = surfaces().of(eta);
    in.samples = info.default_samples;
    std::vector<float> rgb(3 * kCount);

    const KernelFns& counting = counted_fns<KernelFns>();
    const KernelWork before = counting.work();
    counting.techniques[technique](f, in, rgb.data());
    const KernelWork after = counting.work();
    const KernelFn kernel = pick<KernelFns>(isa).techniques[technique];
    for (auto _ : state) {
        kernel(f, in, rgb.data());
        benchmark::DoNotOptimize(rgb.data());
    }
    state.counters["operations"] = static_cast<double>(after.operations - before.operations) / kCount;
    state.counters["bytes"] = static_cast<double>(after.bytes - before.bytes) / kCount;
    state.counters["fragments"] = kCount;
}

const bool kRegistered = [] {
    for (Isa isa : program_isas())
        for (std::size_t i = 0; i < techniques().size() && isa_available(isa); ++i)
            for (const char* eta : {"0.5", "0.8"}) {
                const std::string name = std::string("kernel/") + techniques()[i].name + "/eta:" + eta + "/" + isa_name(isa);
                benchmark::RegisterBenchmark(name.c_str(), [i, eta, isa](benchmark::State& state) {
                    run(state, i, std::strtof(eta, nullptr), isa);
                })->Unit(benchmark::kMicrosecond);
            }
    return true;
}();

} // namespace
} // namespace burnish
