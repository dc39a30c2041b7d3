#include "tests/unit/lanes/run_lanes.h"

#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#include "shading/techniques/bent_normal.k.h"
#include "shading/techniques/lobe_line.k.h"
#include "shading/techniques/major_axis.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

// Returns 1 plus twice the sum of held(1), held(2)..., up to the first cell that holds nothing.
template <class Held> real cells_of(Held held)
{
    real sum = lit(1.0);
    mask more = lit(0.0) < lit(1.0);
    for (int i = 1; any(more); ++i) {
        const real x = held(i);
        more = both(more, x > lit(0.0));
        sum = select(more, sum + lit(2.0) * x, sum);
    }
    return sum;
}

real3 axis(int i)
{
    return vec3_of(lit(i == 0 ? 1.0 : 0.0), lit(i == 1 ? 1.0 : 0.0), lit(i == 2 ? 1.0 : 0.0));
}

constexpr test::Kernel kKernels[] = {
#include "tests/unit/techniques/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
