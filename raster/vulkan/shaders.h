// SPIR-V stages: built into the program, or from a folder of NAME.spv files (tests compile changed sources).
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

extern const EmbeddedFile kShadeStage; // the source of stage `shade`, preprocessed

struct EmbeddedShader {
    const char* name;
    const EmbeddedFile* file;
};

// Returns a stage's words. name: as in stages.txt, or of `more`. folder: empty for built-in stages.
Result<std::vector<std::uint32_t>> shader_words(const std::string& name, const std::string& folder,
                                                const std::vector<EmbeddedShader>& more = {});

} // namespace burnish
