// One lane of double precision: shows where floats lose digits.
#pragma once
#define BN_ORACLE
#include "core/simd/lanes_scalar.h"
