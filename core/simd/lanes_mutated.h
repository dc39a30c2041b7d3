// One lane of kernels with mistakes: see BN_MUTANT in shading/lang/lang.h.
#pragma once
#include "core/simd/lanes_scalar.h"
