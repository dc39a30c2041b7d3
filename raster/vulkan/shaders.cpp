#include "raster/vulkan/shaders.h"

#include <cstring>

#include "core/base/file.h"

namespace burnish {

Result<std::vector<std::uint32_t>> shader_words(const std::string& name, const std::string& folder)
{
    if (folder.empty()) {
        for (const ShaderText& shader : built_in_shaders())
            if (name == shader.name)
                return std::vector<std::uint32_t>(shader.words.begin(), shader.words.end());
        return Error{ExitCode::internal, "", "", "no shader '" + name + "' in the program"};
    }
    const std::string path = folder + "/" + name + ".spv";
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, 16u << 20);
    if (!bytes)
        return bytes.error();
    constexpr std::uint32_t kMagic = 0x07230203;
    std::vector<std::uint32_t> words(bytes->size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes->data(), words.size() * sizeof(std::uint32_t));
    if (words.size() < 5 || words[0] != kMagic || bytes->size() % sizeof(std::uint32_t))
        return Error{ExitCode::bad_input, path, "", "is no SPIR-V"};
    return words;
}

} // namespace burnish
