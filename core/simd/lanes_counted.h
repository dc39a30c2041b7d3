// One lane that counts operations and bytes.
#pragma once
#define BN_COUNTED
#include "core/simd/lanes_scalar.h"
