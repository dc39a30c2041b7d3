// Bake times, and the cost of a trilinear cube fetch for each instruction set.
#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

#include "bench/micro/bake_fetch.h"
#include "core/scene/builtin/builtin.h"
#include "raster/frame/upload.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/texture.h"

namespace burnish {
namespace {

const Image& studio()
{
    static const Image image = std::move(*make_builtin_environment("studio"));
    return image;
}

// Bakes a 512^2 cube with 9 levels and 1024 samples, without the cache. Argument: threads, 0 all cores.
void bake_512(benchmark::State& state)
{
    const Jobs jobs(static_cast<int>(state.range(0)));
    EnvironmentOptions o;
    o.use_cache = false;
    for (auto _ : state) {
        const Result<Environment> e = bake_environment(studio(), "studio", o, jobs);
        benchmark::DoNotOptimize(e->specular.texels.data());
        state.counters["energy_error"] = e->energy_cube / e->energy_source - 1.0;
    }
}
BENCHMARK(bake_512)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void cached_512(benchmark::State& state)
{
    const Jobs jobs(0);
    const EnvironmentOptions o; // in the user's cache folder
    const Result<Environment> first = bake_environment(studio(), "studio", o, jobs);
    for (auto _ : state) {
        const Result<Environment> e = bake_environment(studio(), "studio", o, jobs);
        benchmark::DoNotOptimize(e->specular.texels.data());
    }
}
BENCHMARK(cached_512)->Unit(benchmark::kMillisecond)->UseRealTime();

void dfg_64(benchmark::State& state)
{
    const Jobs jobs(1);
    for (auto _ : state)
        benchmark::DoNotOptimize(bake_dfg(64, static_cast<int>(state.range(0)), jobs).pairs.data());
}
BENCHMARK(dfg_64)->Arg(256)->Arg(1024)->Unit(benchmark::kMillisecond);

void texture_pyramid(benchmark::State& state)
{
    const int side = static_cast<int>(state.range(0));
    Image image = make_image(side, side, 3, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(i * 31 / 7);
    for (auto _ : state)
        benchmark::DoNotOptimize(make_texture_pyramid(image, {}, TextureEncoding::srgb).texels.data());
}
BENCHMARK(texture_pyramid)->Arg(1024)->Arg(1000)->Unit(benchmark::kMillisecond);

struct Fetches {
    CubeMap cube;
    std::vector<float> x, y, z, lod, rgb;
};

// Reflections off a screen of smooth surfaces: neighbouring lanes look in neighbouring directions. Levels of a 512^2
// cube.
const Fetches& screen()
{
    static const Fetches fetches = [] {
        Fetches f;
        EnvironmentOptions o;
        o.use_cache = false;
        o.samples = 1;
        f.cube = bake_environment(studio(), "studio", o, Jobs(0))->specular;
        const int width = 512, height = 256;
        for (int i = 0; i < width * height; ++i) {
            const float u = static_cast<float>(i % width) / width, v = static_cast<float>(i / width) / height;
            f.x.push_back(std::sin(7.0f * u + 2.0f * v));
            f.y.push_back(std::cos(5.0f * v - 3.0f * u));
            f.z.push_back(std::sin(4.0f * v + 1.0f));
            f.lod.push_back(3.0f + 3.0f * std::sin(3.0f * u * v));
        }
        f.rgb.resize(3 * f.x.size());
        return f;
    }();
    return fetches;
}

void cube_fetch(benchmark::State& state, Isa isa, int fetches)
{
    const Fetches& f = screen();
    const FetchInput input = {f.x.data(), f.y.data(), f.z.data(), f.lod.data(), static_cast<int>(f.x.size())};
    std::vector<float> rgb(f.rgb.size());
    const FetchFns& fns = pick<FetchFns>(isa);
    const auto run = fetches == 16 ? fns.sixteen : fns.single;
    for (auto _ : state) {
        run(f.cube.texels.data(), f.cube.size, f.cube.levels, input, rgb.data());
        benchmark::DoNotOptimize(rgb.data());
    }
    state.counters["s/fetch"] = benchmark::Counter(static_cast<double>(state.iterations() * fetches) * input.n,
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Times the 2D filter on a 1024^2 texture.
void texture_fetch(benchmark::State& state, Isa isa, int taps)
{
    const Fetches& f = screen();
    const FetchInput input = {f.x.data(), f.y.data(), nullptr, nullptr, static_cast<int>(f.x.size())};
    std::vector<float> rgb(f.rgb.size());
    static const TexturePyramid pyramid = make_texture_pyramid(make_image(1024, 1024, 3, PixelType::u8), {}, TextureEncoding::srgb);
    static const TextureParams texture = texture_params(pyramid);
    for (auto _ : state) {
        pick<FetchFns>(isa).texture(texture, taps, input, rgb.data());
        benchmark::DoNotOptimize(rgb.data());
    }
    state.counters["s/fetch"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * input.n, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const bool kRegistered = [] {
    const auto name = [](const char* what, int n, Isa isa) { return std::string(what) + std::to_string(n) + "/" + isa_name(isa); };
    for (Isa isa : isas_with<FetchFns>()) {
        for (int n : {1, 16})
            benchmark::RegisterBenchmark(name("cube_fetch/", n, isa).c_str(), cube_fetch, isa, n);
        for (int n : {1, 4})
            benchmark::RegisterBenchmark(name("texture_fetch/", n, isa).c_str(), texture_fetch, isa, n);
    }
    return true;
}();

} // namespace
} // namespace burnish
