#include "shading/bake/mipnet/albedo_fns.h"

#include "shading/bake/mipnet/tensor.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace mipnet_lanes {
namespace {

namespace net = burnish::mipnet;

// Computes the light that lobes reflect. Half vectors are drawn as GGX normals with the texel's widths, for every lobe. GGX has the
// longest tail, so no weight is large.
template <int lobe, bool seen_anyhow> void albedo_of(const net::AlbedoWork& w)
{
    const real everywhere = lit(6.283185307179586 * (1.0 - net::kLeastLightZ)); // solid angle of lights
    for (std::size_t at = 0; at < w.texels; at += static_cast<std::size_t>(kLanes)) {
        const auto channel = [&](std::size_t c) { return load(w.planes + c * w.texels + at); };
        const auto drawn = [&](std::size_t k) { return load(w.drawn + k * w.drawn_apart + at); };
        // Draw a half vector, and mirror the eye
        const lobe_place<real> x = lobe_place_of(texel<real>{channel(0), channel(1), channel(2), channel(3), channel(4)});
        const real3 o = vec3_of(drawn(0), drawn(1), drawn(2));
        const real u = drawn(3), v = drawn(4);
        const real t = x.b * u - x.c * v, b = x.a * v - x.c * u, length = lit(1.0) / sqrt(t * t + b * b + lit(1.0));
        const local<real> h = {t * length, b * length, length};
        const frame<real>& f = x.f;
        const real3 m =
            vec3_of(f.tx * h.t + f.m * h.b + f.nx * h.n, f.m * h.t + f.by * h.b + f.ny * h.n, f.nz * h.n - f.nx * h.t - f.ny * h.b);
        const real om = k_dot3(o, m);
        const real3 i = m * (om * lit(2.0)) - o;
        // Evaluate the mirrored direction
        const mask meets = both(om > lit(1e-4), i.z > lit(net::kLeastLightZ));
        const real g = lit(1.0) - min(max(om, lit(1e-4)), lit(1.0)), g2 = g * g, grazing = g2 * g2 * g;
        const light mirrored = {i, o, m, max(om, lit(1e-4)), lit(1.0), lit(0.0), lit(1.0)};
        const real density = ggx_normals(x, h) * h.n / (max(om, lit(1e-4)) * lit(4.0)); // of i, 1/sr
        const real specular = select(meets, radiance<lobe, seen_anyhow>(x, mirrored) / density, lit(0.0));
        // Add the diffuse part under any light
        real scaled = specular * (splat(w.f0) * (lit(1.0) - grazing));
        if (w.diffuse > 0.0f) {
            light any = light_of<lobe>(vec3_of(drawn(5), drawn(6), drawn(7)), o, splat(w.f0), splat(w.diffuse), lit(1.0));
            any.fresnel = lit(0.0);
            scaled += radiance<lobe, seen_anyhow>(x, any) * everywhere;
        }
        store(w.scaled + at, scaled), store(w.rest + at, specular * grazing);
    }
}

void albedo(const net::AlbedoWork& work)
{
    switch (work.lobe) {
    case net::Lobe::ggx_aniso:
        return work.seen_anyhow ? albedo_of<0, true>(work) : albedo_of<0, false>(work);
    case net::Lobe::beckmann:
        return work.seen_anyhow ? albedo_of<1, true>(work) : albedo_of<1, false>(work);
    case net::Lobe::ashikhmin_shirley:
        return work.seen_anyhow ? albedo_of<2, true>(work) : albedo_of<2, false>(work);
    }
}

constexpr net::AlbedoFns kAlbedoFns = {albedo};

} // namespace
} // namespace mipnet_lanes

BN_DEFINE_FNS(mipnet::AlbedoFns, mipnet_lanes::kAlbedoFns)

} // namespace BN_ISA_NS
} // namespace burnish
