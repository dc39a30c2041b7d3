// One lane that counts its work.
#pragma once
#define BN_COUNTED
#include "core/simd/lanes_scalar.h"
