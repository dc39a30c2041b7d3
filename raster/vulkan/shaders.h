// The stages as SPIR-V: compiled with the program, or from a folder of NAME.spv (what tests make of changed texts).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct ShaderText {
    const char* name;
    std::span<const std::uint32_t> words;
};
const std::vector<ShaderText>& built_in_shaders(); // by the names of stages.txt

// folder: empty for those of the program.
Result<std::vector<std::uint32_t>> shader_words(const std::string& name, const std::string& folder);

} // namespace burnish
