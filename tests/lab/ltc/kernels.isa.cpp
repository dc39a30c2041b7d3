#include "tests/unit/lanes/run_lanes.h"

#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_round.k.h"
#include "shading/lights/ltc_table.k.h"
#include "shading/lights/ltc_texture.k.h"
#include "shading/models/ashikhmin_shirley.k.h"
#include "shading/models/beckmann.k.h"
#include "shading/models/ward.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

// Returns a view's table. `levels` counts the nodes along alpha. `level` holds the entry format: basis (bits 0-1), over alpha (4), inverse
// (8).
ltc_table table_of(const test::TexelView& t)
{
    return {t.texels, 1, t.level & 3, t.level >> 2 & 1, t.level >> 3 & 1, t.levels};
}

// Builds a lobe from the columns of M.
ltc_lobe lobe_at(const real* a)
{
    ltc_lobe lobe = ltc_cosine();
    lobe.m0 = vec3_at(a), lobe.m1 = vec3_at(a + 3), lobe.m2 = vec3_at(a + 6);
    return ltc_inverted(lobe);
}

ltc_polygon polygon_at(const real* a, int corners)
{
    ltc_polygon p;
    for (int i = 0; i < corners; ++i)
        p.corner[i] = vec3_at(a + 3 * i);
    return p;
}

void put_light(ltc_light light, real* r)
{
    r[0] = light.part;
    put_vec3(light.flow, r + 1);
}

constexpr test::Kernel kKernels[] = {
#include "tests/lab/ltc/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
