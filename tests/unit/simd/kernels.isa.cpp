#include "tests/unit/lanes/run_lanes.h"

#include "shading/kernels/math.k.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace {

constexpr test::Kernel kKernels[] = {
#include "tests/unit/simd/kernels.def"
};

} // namespace

BN_DEFINE_KERNELS(kKernels)

} // namespace BN_ISA_NS
} // namespace burnish
