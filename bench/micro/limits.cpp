// Limits of this machine on one core: floating-point operations, random 16-byte loads from each memory level,
// bandwidth. Also the cost of single lane operations.
#include <benchmark/benchmark.h>
#include <cstring>
#include <string>
#include <vector>

#include "bench/micro/limits.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

typedef int Quad __attribute__((vector_size(16)));

std::uint64_t mix(std::uint64_t z) // SplitMix64
{
    z += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

// Random aligned 16-byte loads with indices read in order, like texel fetches. Argument: KiB of memory to load from.
void random_loads(benchmark::State& state)
{
    constexpr std::size_t kLoads = 4096; // their indices are 16 KiB, read in order
    const std::size_t quads = static_cast<std::size_t>(state.range(0)) * 1024 / sizeof(Quad);
    std::vector<Quad> memory(quads, Quad{1, 2, 3, 4});
    // Use new places in every round: otherwise a large memory is only tested at its first 4096 places.
    constexpr std::size_t kRounds = 64;
    std::vector<std::uint32_t> index(kLoads * kRounds);
    for (std::size_t i = 0; i < index.size(); ++i)
        index[i] = static_cast<std::uint32_t>(mix(i) % quads);
    std::size_t round = 0;
    for (auto _ : state) {
        const std::uint32_t* at = index.data() + (round++ % kRounds) * kLoads;
        Quad sum[4] = {};
        for (std::size_t i = 0; i < kLoads; i += 4)
            for (std::size_t k = 0; k < 4; ++k)
                sum[k] ^= memory[at[i + k]];
        benchmark::DoNotOptimize(sum);
    }
    state.counters["loads"] = benchmark::Counter(static_cast<double>(state.iterations()) * kLoads, benchmark::Counter::kIsRate);
}
BENCHMARK(random_loads)->Name("limit/random_loads/KiB")->Arg(16)->Arg(512)->Arg(8192)->Arg(262144);

// Reads bytes in order. Argument: MiB.
void read_in_order(benchmark::State& state)
{
    const std::size_t quads = (static_cast<std::size_t>(state.range(0)) << 20) / sizeof(Quad);
    const std::vector<Quad> memory(quads, Quad{1, 2, 3, 4});
    for (auto _ : state) {
        Quad sum[8] = {};
        for (std::size_t i = 0; i < quads; i += 8)
            for (std::size_t k = 0; k < 8; ++k)
                sum[k] ^= memory[i + k];
        benchmark::DoNotOptimize(sum);
    }
    state.counters["bytes"] = benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(quads * sizeof(Quad)),
                                                 benchmark::Counter::kIsRate);
}
BENCHMARK(read_in_order)->Name("limit/read/MiB")->Arg(256)->Unit(benchmark::kMillisecond);

// Writes bytes in order, like an image. Argument: MiB.
void write_in_order(benchmark::State& state)
{
    std::vector<char> memory(static_cast<std::size_t>(state.range(0)) << 20);
    for (auto _ : state) {
        std::memset(memory.data(), 1, memory.size());
        benchmark::ClobberMemory();
    }
    state.counters["bytes"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(memory.size()), benchmark::Counter::kIsRate);
}
BENCHMARK(write_in_order)->Name("limit/write/MiB")->Arg(256)->Unit(benchmark::kMillisecond);

void operations(benchmark::State& state, Isa isa)
{
    constexpr int kSteps = 1000;
    const LimitFns& fns = pick<LimitFns>(isa);
    for (auto _ : state)
        benchmark::DoNotOptimize(fns.multiply_add(kSteps, 0.999f));
    state.counters["operations"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * 2.0 * kSteps * kMultiplyAddChains * fns.lanes, benchmark::Counter::kIsRate);
}

void lane_loop(benchmark::State& state, Isa isa, int loop)
{
    std::vector<float> a(kLaneLoopCount), b(kLaneLoopCount), out(kLaneLoopCount);
    std::vector<std::int32_t> index(kLaneLoopCount);
    std::vector<std::uint16_t> texels(4 * kLaneLoopCount + 64, 0x3c00); // halves with value 1
    for (std::size_t i = 0; i < kLaneLoopCount; ++i) {
        a[i] = 1.0f + static_cast<float>(mix(i) >> 40) * 0x1p-24f;
        b[i] = 0.5f + static_cast<float>(mix(~i) >> 40) * 0x1p-25f;
        index[i] = static_cast<std::int32_t>(i * 389 % kLaneLoopCount); // 389 is odd: a permutation
    }
    const LaneLoopInput in = {a.data(), b.data(), index.data(), texels.data(), out.data()};
    for (auto _ : state) {
        pick<LimitFns>(isa).loops[loop].run(in);
        benchmark::ClobberMemory();
    }
    state.counters["s/element"] = benchmark::Counter(static_cast<double>(state.iterations()) * kLaneLoopCount,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const bool kRegistered = [] {
    for (Isa isa : program_isas()) {
        if (!isa_available(isa))
            continue;
        benchmark::RegisterBenchmark((std::string("limit/operations/") + isa_name(isa)).c_str(),
                                     [isa](benchmark::State& state) { operations(state, isa); });
        for (int i = 0; i < pick<LimitFns>(isa).loop_count; ++i)
            benchmark::RegisterBenchmark((std::string("lanes/") + pick<LimitFns>(isa).loops[i].name + "/" + isa_name(isa)).c_str(),
                                         [isa, i](benchmark::State& state) { lane_loop(state, isa, i); });
    }
    return true;
}();

} // namespace
} // namespace burnish
