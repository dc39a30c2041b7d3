// Mip levels of a material's normals and lobes: time for each level 0 texel, by filter and size, beside a copy of the
// same memory.
#include <benchmark/benchmark.h>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include "shading/bake/mip/filter.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/shipped.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
namespace {

struct Maps {
    Image normal, roughness;
    MipMaps maps() const
    {
        MipMaps m;
        m.normal = &normal, m.roughness = &roughness;
        return m;
    }
};

const Maps& grain(int side) // 8-bit codes
{
    static std::map<int, Maps> made;
    Maps& m = made[side];
    if (!m.normal.bytes.empty())
        return m;
    m.normal = m.roughness = make_image(side, side, 3, PixelType::u8);
    mipnet::Random random(5);
    for (std::size_t i = 0; i < m.normal.bytes.size(); i += 3) {
        const std::uint64_t bits = random.bits();
        m.normal.bytes[i] = static_cast<std::byte>(90 + bits % 77), m.normal.bytes[i + 1] = static_cast<std::byte>(90 + (bits >> 8) % 77);
        m.normal.bytes[i + 2] = std::byte{245}, m.roughness.bytes[i + 1] = static_cast<std::byte>(50 + (bits >> 16) % 50);
    }
    return m;
}

void count_texels(benchmark::State& state, int side)
{
    const double texels = static_cast<double>(state.iterations()) * side * side;
    state.counters["s/texel"] = benchmark::Counter(texels, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Makes levels on one thread. `wide`: 2x64/2x128 nets, untrained.
void mip_levels(benchmark::State& state, MipFilter filter, bool wide)
{
    const int side = static_cast<int>(state.range(0));
    const MipSource source(grain(side).maps());
    std::optional<mipnet::Weights> net;
    if (wide) {
        net.emplace();
        net->shape.a.width = 64, net->shape.b.width = 128;
        net->numbers = mipnet::start_weights(mipnet::plan_of(net->shape), 1);
    }
    for (auto _ : state)
        benchmark::DoNotOptimize(make_mip_levels(source, filter, 0.7f, Jobs(1), {net ? &*net : nullptr, true, {}}).levels.data());
    count_texels(state, side);
}

// Copies the bytes of maps and levels to other memory.
void mip_copy(benchmark::State& state)
{
    const int side = static_cast<int>(state.range(0));
    const Maps& maps = grain(side);
    std::vector<MipTexel> levels;
    for (int l = 1; side >> l > 0; ++l)
        levels.resize(levels.size() + static_cast<std::size_t>(side >> l) * static_cast<std::size_t>(side >> l));
    for (auto _ : state) {
        const Image normal = maps.normal, roughness = maps.roughness;
        const std::vector<MipTexel> made = levels;
        benchmark::DoNotOptimize(normal.bytes.data()), benchmark::DoNotOptimize(roughness.bytes.data()),
            benchmark::DoNotOptimize(made.data());
    }
    count_texels(state, side);
}

void sides(benchmark::internal::Benchmark* b)
{
    b->RangeMultiplier(4)->Range(256, 4096)->Arg(8192)->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(mip_levels, baseline, kMipFilter_baseline, false)->Apply(sides);
BENCHMARK_CAPTURE(mip_levels, kappa, kMipFilter_kappa, false)->Apply(sides);
BENCHMARK_CAPTURE(mip_levels, mipnet_2x32_2x64, kMipFilter_mipnet, false)->Apply(sides);
BENCHMARK_CAPTURE(mip_levels, mipnet_2x64_2x128, kMipFilter_mipnet, true)->Apply(sides);
BENCHMARK(mip_copy)->Apply(sides);

} // namespace
} // namespace burnish
