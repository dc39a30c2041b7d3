// The stages as SPIR-V: compiled with the program, or from a folder of NAME.spv (what tests make of changed texts).
#pragma once
#include <burnish_stages.h>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/embedded.h"
#include "core/base/result.h"

namespace burnish {

#define BN_DECLARE_STAGE(NAME) extern const EmbeddedFile stage_##NAME;
BN_STAGES(BN_DECLARE_STAGE)
#undef BN_DECLARE_STAGE

// name: of stages.txt. folder: empty for those of the program.
Result<std::vector<std::uint32_t>> shader_words(const std::string& name, const std::string& folder);

} // namespace burnish
