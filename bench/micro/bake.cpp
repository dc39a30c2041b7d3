// Bake times, and the cost of a trilinear cube fetch by instruction set.
#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

#include "bench/micro/bake_fetch.h"
#include "core/scene/builtin.h"
#include "raster/frame/upload.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment.h"
#include "shading/bake/texture.h"

namespace burnish {
namespace {

const Image& studio()
{
    static const Image image = std::move(*make_builtin_environment("studio"));
    return image;
}

// 512^2 cube, 9 levels, 1024 samples, without the cache. Argument: threads, 0 all cores.
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
        benchmark::DoNotOptimize(bake_dfg(64, static_cast<int>(state.range(0)), jobs).texels.data());
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

// Reflections off a screen of smooth surfaces: neighbouring lanes look in neighbouring directions; the levels
// of 512^2.
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

template <int isa> const FetchFns& fetch_fns_of()
{
    return isa == 2 ? bn_avx512::fetch_fns() : isa == 1 ? bn_avx2::fetch_fns() : bn_scalar::fetch_fns();
}

template <int isa> void cube_fetch(benchmark::State& state)
{
    if (!bake_isa_available(isa)) {
        state.SkipWithError("this processor cannot run it");
        return;
    }
    const Fetches& f = screen();
    const FetchInput input = {f.x.data(), f.y.data(), f.z.data(), f.lod.data(), static_cast<int>(f.x.size())};
    std::vector<float> rgb(f.rgb.size());
    const FetchFns& fns = fetch_fns_of<isa>();
    const auto run = state.range(0) == 16 ? fns.sixteen : fns.single;
    for (auto _ : state) {
        run(f.cube.texels.data(), f.cube.size, f.cube.levels, input, rgb.data());
        benchmark::DoNotOptimize(rgb.data());
    }
    state.counters["s/fetch"] =
        benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)) * input.n,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(cube_fetch<0>)->Arg(1)->Arg(16);
BENCHMARK(cube_fetch<1>)->Arg(1)->Arg(16);
BENCHMARK(cube_fetch<2>)->Arg(1)->Arg(16);

// The 2D filter, of a 1024^2 texture. Argument: taps at most.
template <int isa> void texture_fetch(benchmark::State& state)
{
    if (!bake_isa_available(isa)) {
        state.SkipWithError("this processor cannot run it");
        return;
    }
    const Fetches& f = screen();
    const FetchInput input = {f.x.data(), f.y.data(), nullptr, nullptr, static_cast<int>(f.x.size())};
    std::vector<float> rgb(f.rgb.size());
    static const TexturePyramid pyramid = make_texture_pyramid(make_image(1024, 1024, 3, PixelType::u8), {}, TextureEncoding::srgb);
    static const TextureParams texture = texture_params(pyramid);
    for (auto _ : state) {
        fetch_fns_of<isa>().texture(texture, static_cast<int>(state.range(0)), input, rgb.data());
        benchmark::DoNotOptimize(rgb.data());
    }
    state.counters["s/fetch"] = benchmark::Counter(static_cast<double>(state.iterations()) * input.n,
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(texture_fetch<0>)->Arg(1)->Arg(4);
BENCHMARK(texture_fetch<1>)->Arg(1)->Arg(4);
BENCHMARK(texture_fetch<2>)->Arg(1)->Arg(4);

} // namespace
} // namespace burnish
