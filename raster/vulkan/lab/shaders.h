// SPIR-V of the laboratory's stages.
#pragma once
#include <burnish_lab_stages.h>

#include "core/base/embedded.h"

namespace burnish {

#define BN_DECLARE_STAGE(NAME) extern const EmbeddedFile stage_##NAME;
BN_LAB_STAGES(BN_DECLARE_STAGE)
#undef BN_DECLARE_STAGE

} // namespace burnish
