#include "tests/unit/lanes/run_lanes.h"

#include "shading/kernels/cube_filter.k.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/energy.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

cube_desc cube_of(const test::TexelView& t)
{
    return {t.texels, t.size, t.levels};
}
texture_desc texture_of(const test::TexelView& t)
{
    return {t.texels, t.offset, t.level_width, t.level_height, t.levels, t.wrap_s, t.wrap_t, t.nearest};
}
aniso_lobe lobe_of(const real* a)
{
    const real zero = lit(0.0), one = lit(1.0);
    return {vec3_of(one, zero, zero), vec3_of(zero, one, zero), a[0], a[1]};
}
real3 up()
{
    return vec3_of(lit(0.0), lit(0.0), lit(1.0));
}
int largest(real x)
{
#ifdef BN_ORACLE
    return static_cast<int>(x);
#else
    float lanes[kLanes];
    store(lanes, reduce_max(x));
    return static_cast<int>(lanes[0]);
#endif
}
void put_vec4(real4 v, real* r)
{
    r[0] = v.x, r[1] = v.y, r[2] = v.z, r[3] = v.w;
}
void put_dfg(dfg_value d, real* r)
{
    r[0] = d.scale, r[1] = d.bias;
}

constexpr test::Kernel kKernels[] = {
#include "tests/unit/bake/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
