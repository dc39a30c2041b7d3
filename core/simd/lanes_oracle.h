// One lane of double precision: shows where the floats of the instruction sets lose digits.
#pragma once
#define BN_ORACLE
#include "core/simd/lanes_scalar.h"
