// Constants of one pass over a band of rows (GpuPass).
#ifndef BN_PASS_GLSL
#define BN_PASS_GLSL

#include "shading/lang/gpu_records.h"

layout(push_constant) uniform BnPass { GpuPass pass; };

#endif
