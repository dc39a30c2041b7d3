#include "shading/bake/mipnet/mipnet_fns.h"

#include "shading/bake/mipnet/forward.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace mipnet_lanes {
namespace {

struct ForwardMemory {
    NetMemory a, b;
    number* first;
};
ForwardMemory forward_memory(Pool& pool, const Plan& plan, std::size_t texels)
{
    ForwardMemory m = {};
    m.a = net_memory(pool, plan.a, 1), m.b = net_memory(pool, plan.b, 1);
    m.first = pool.take<number>(kPlanes * texels);
    return m;
}
std::size_t forward_bytes(const Plan& plan, std::size_t texels)
{
    Pool pool = {nullptr};
    forward_memory(pool, plan, texels);
    return pool.used;
}

void forward(const net::ForwardWork& work)
{
    const Plan& plan = *work.plan;
    Pool pool = {static_cast<char*>(work.memory)};
    const ForwardMemory m = forward_memory(pool, plan, work.texels);
    const auto* weights = static_cast<const number*>(work.weights);
    auto* out = static_cast<number*>(work.out);
    const bool all = work.grandchildren != nullptr && plan.b.count > 0;
    Sources s = {static_cast<const number*>(work.children),
                 static_cast<const number*>(work.grandchildren),
                 static_cast<const number*>(work.great),
                 nullptr,
                 work.texels,
                 plan.far};
    for (std::size_t block = 0; block < blocks_of(s.n); ++block) {
        s.first = nullptr;
        forward_block(plan, weights, plan.a, s, block, 0, m.a, all ? m.first : out);
        s.first = m.first;
        if (all)
            forward_block(plan, weights, plan.b, s, block, 0, m.b, out);
    }
}

#ifndef BN_ORACLE
template <int lobe> void radiance_of(const net::RadianceWork& w)
{
    const real f0 = splat(w.f0), diffuse = splat(w.diffuse);
    for (std::size_t i = 0; i < w.texels; i += kLane) {
        const int n = w.texels - i < kLane ? static_cast<int>(w.texels - i) : kLanes;
        const auto at = [&](const float* planes, std::size_t c) { return load_first(planes + c * w.texels + i, n); };
        const texel<real> t = {at(w.planes, 0), at(w.planes, 1), at(w.planes, 2), at(w.planes, 3), at(w.planes, 4)};
        const real3 to_light = vec3_of(at(w.to_light, 0), at(w.to_light, 1), at(w.to_light, 2));
        const real3 to_eye = vec3_of(at(w.to_eye, 0), at(w.to_eye, 1), at(w.to_eye, 2));
        const light l = light_of<lobe>(to_light, to_eye, f0, diffuse, at(w.intensity, 0));
        store_first(w.out + i, radiance<lobe>(lobe_place_of(t), l), n);
    }
}
#endif

void radiances([[maybe_unused]] const net::RadianceWork& work)
{
#ifndef BN_ORACLE
    switch (work.lobe) {
    case net::Lobe::ggx_aniso:
        return radiance_of<0>(work);
    case net::Lobe::beckmann:
        return radiance_of<1>(work);
    case net::Lobe::ashikhmin_shirley:
        return radiance_of<2>(work);
    }
#endif
}

void toned([[maybe_unused]] std::size_t count, [[maybe_unused]] const float* from, [[maybe_unused]] float* to)
{
#ifndef BN_ORACLE
    for (std::size_t i = 0; i < count; i += kLane)
        store(to + i, tone(load(from + i)).shown);
#endif
}

constexpr net::Fns kFns = {sizeof(number), forward_bytes, forward, radiances, toned};

} // namespace
} // namespace mipnet_lanes

BN_DEFINE_FNS(mipnet::Fns, mipnet_lanes::kFns)

} // namespace BN_ISA_NS
} // namespace burnish
