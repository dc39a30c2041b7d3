#include "tests/unit/lanes/run_lanes.h"

#include "shading/bake/mipnet/cascade.h"
#include "shading/models/ashikhmin_shirley.k.h"
#include "shading/models/beckmann.k.h"
#include "shading/models/ggx_aniso.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

namespace m = mipnet_lanes;

// Returns number k of the list a, with its k-th partial set to 1.
m::dual changing(const real* a, int k)
{
    m::dual d = m::constant(a[k]);
    real* const partials[] = {&d.d0, &d.d1, &d.d2, &d.d3, &d.d4};
    *partials[k] = lit(1.0);
    return d;
}
m::texel<m::dual> changing_texel(const real* a)
{
    return {changing(a, 0), changing(a, 1), changing(a, 2), changing(a, 3), changing(a, 4)};
}
m::texel<real> texel_at(const real* a)
{
    return {a[0], a[1], a[2], a[3], a[4]};
}
void put_dual(const m::dual& d, real* r)
{
    r[0] = d.v, r[1] = d.d0, r[2] = d.d1, r[3] = d.d2, r[4] = d.d3, r[5] = d.d4;
}
void put_projected(const real* a, real* r)
{
    m::dual channels[5];
    m::channels_of(m::proj(changing_texel(a)), channels);
    for (int k = 0; k < 5; ++k)
        put_dual(channels[k], r + 6 * k);
}
void put_frame(const real* a, real* r)
{
    const m::frame<m::dual> f = m::frame_of(changing(a, 0), changing(a, 1));
    put_dual(f.nz, r), put_dual(f.tx, r + 6), put_dual(f.m, r + 12), put_dual(f.by, r + 18);
}
template <int lobe> void put_radiance(const real* a, real* r)
{
    const m::light l = m::light_of<lobe>(vec3_at(a + 5), vec3_at(a + 8), a[11], a[12], lit(1.0));
    put_dual(m::radiance<lobe>(m::lobe_place_of(changing_texel(a)), l), r);
}
// Writes the normal densities of a texel whose normal is +z.
void put_normals(const real* a, real* r)
{
    const m::lobe_place<real> place = m::lobe_place_of(texel_at(a));
    const m::local<real> h = {a[5], a[6], a[7]};
    r[0] = m::ggx_normals(place, h), r[1] = m::beckmann_normals(place, h), r[2] = m::phong_normals(place, h) * lit(4.0);
}
// Writes the densities of visible normals over four times the eye's cosine. They integrate to 1 over i.
void put_seen(const real* a, real* r)
{
    const m::lobe_place<real> place = m::lobe_place_of(texel_at(a));
    const real3 wo = vec3_at(a + 5), wi = vec3_at(a + 8);
    const m::local<real> h = m::local_of(place.f, k_normalize3(wo + wi)), o = m::local_of(place.f, wo);
    const real quarter = lit(0.25) / o.n, up = select(h.n > lit(0.0), lit(1.0), lit(0.0));
    const real root = sqrt(m::projected2(place, o) + o.n * o.n);
    const m::local<real> safe = {h.t, h.b, max(h.n, lit(1e-3))};
    r[0] = m::ggx_normals(place, safe) * (lit(2.0) * o.n / (o.n + root)) * quarter * up;
    r[1] = m::beckmann_normals(place, safe) / (lit(1.0) + m::beckmann_shadow(place, o)) * quarter * up;
}

constexpr test::Kernel kKernels[] = {
#include "tests/unit/mipnet/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
