// Image metrics on a pair of 3840 x 2160 images with 8 bits.
#include <benchmark/benchmark.h>
#include <random>

#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"

namespace burnish {
namespace {

constexpr int kWidth = 3840, kHeight = 2160;

Image noise(unsigned seed, PixelType type)
{
    std::mt19937 random(seed);
    Image image = make_image(kWidth, kHeight, 3, type);
    if (type == PixelType::u8)
        for (std::byte& b : image.bytes)
            b = static_cast<std::byte>(random() >> 24);
    else
        for (std::size_t i = 0; i < image.bytes.size() / sizeof(float); ++i)
            image.f32()[i] = static_cast<float>(random() >> 16) * 1e-3f;
    return image;
}

// threads: 0 means all cores.
void flip_ldr_4k(benchmark::State& state, Isa isa, int threads)
{
    FlipOptions options;
    options.isa = isa;
    const Image reference = noise(1, PixelType::u8), test = noise(2, PixelType::u8);
    const Jobs jobs(threads);
    for (auto _ : state)
        benchmark::DoNotOptimize(flip_ldr(reference, test, options, jobs).error.bytes.data());
}

const bool kRegistered = [] {
    for (Isa isa : program_isas())
        for (int threads : {1, 0}) {
            const std::string name = std::string("flip_ldr_4k/") + isa_name(isa) + "/threads:" + std::to_string(threads);
            if (isa_available(isa))
                benchmark::RegisterBenchmark(name.c_str(), flip_ldr_4k, isa, threads)
                    ->Unit(benchmark::kMillisecond)
                    ->MeasureProcessCPUTime()
                    ->UseRealTime();
        }
    return true;
}();

// Uses eight exposures.
void flip_hdr_4k(benchmark::State& state)
{
    FlipOptions options;
    options.exposures = 8;
    const Image reference = noise(1, PixelType::f32), test = noise(2, PixelType::f32);
    const Jobs jobs(static_cast<int>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(flip_hdr(reference, test, options, jobs).error.bytes.data());
}
BENCHMARK(flip_hdr_4k)->Arg(0)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void figures_4k(benchmark::State& state)
{
    const Image reference = noise(1, PixelType::u8), test = noise(2, PixelType::u8);
    const Jobs jobs(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(pixel_figures(reference, test, jobs));
        benchmark::DoNotOptimize(ssim(reference, test, jobs));
    }
}
BENCHMARK(figures_4k)->Arg(0)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

} // namespace
} // namespace burnish
