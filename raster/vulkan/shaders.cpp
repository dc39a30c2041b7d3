#include "raster/vulkan/shaders.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "raster/vulkan/stage_files.h"
#include "raster/vulkan/vulkan_renderer.h"

namespace burnish {
namespace {

const EmbeddedShader kEmbedded[] = {
#define BN_STAGE_ROW(NAME) {#NAME, &stage_##NAME},
    BN_STAGES(BN_STAGE_ROW)
#undef BN_STAGE_ROW
};

const EmbeddedFile* embedded(const std::string& name, const std::vector<EmbeddedShader>& more)
{
    const auto is_it = [&](const EmbeddedShader& shader) { return name == shader.name; };
    const EmbeddedShader* const own = std::find_if(std::begin(kEmbedded), std::end(kEmbedded), is_it);
    if (own != std::end(kEmbedded))
        return own->file;
    const auto other = std::find_if(more.begin(), more.end(), is_it);
    return other == more.end() ? nullptr : other->file;
}

std::vector<std::uint32_t> words_of(const void* bytes, std::size_t size)
{
    std::vector<std::uint32_t> words(size / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes, words.size() * sizeof(std::uint32_t));
    return words;
}

} // namespace

Result<std::vector<std::uint32_t>> shader_words(const std::string& name, const std::string& folder, const std::vector<EmbeddedShader>& more)
{
    if (folder.empty()) {
        if (const EmbeddedFile* const file = embedded(name, more))
            return words_of(file->bytes, file->size);
        return Error{ExitCode::internal, "", "", "no shader '" + name + "' in the program"};
    }
    const std::string path = folder + "/" + name + ".spv";
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, 16u << 20);
    BN_TRY(bytes);
    constexpr std::uint32_t kSpirvMagic = 0x07230203;
    std::vector<std::uint32_t> words = words_of(bytes->data(), bytes->size());
    if (words.size() < 5 || words[0] != kSpirvMagic || bytes->size() % sizeof(std::uint32_t))
        return Error{ExitCode::bad_input, path, "", "is no SPIR-V"};
    return words;
}

Status write_stages(const std::string& folder)
{
    for (const EmbeddedShader& stage : kEmbedded)
        BN_TRY(write_file_atomic(folder + "/" + stage.name + ".spv", stage.file->bytes, stage.file->size));
    return {};
}

Result<std::string> shade_stage_source()
{
    return std::string(kShadeStage.bytes, kShadeStage.size);
}

} // namespace burnish
