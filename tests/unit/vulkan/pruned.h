// Shared parts of the tests of pruned stages: a material, and what spirv-val says of a stage.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

#include "raster/frame/frame.h"
#include "raster/vulkan/frame_numbers.h"
#include "raster/vulkan/prune.h"
#include "shading/lang/records.h"

namespace burnish::test {

using Words = std::vector<std::uint32_t>;

// Returns a material of the technique bent_normal, without textures and without anything special.
inline MaterialRecord plain_material()
{
    MaterialRecord m = {};
    while (techniques()[static_cast<std::size_t>(m.technique)].name != std::string_view("bent_normal"))
        ++m.technique;
    for (TextureBinding& t : m.textures)
        t.texture = -1;
    return m;
}

// Removes OpName and OpMemberName, which slow spirv-val down thirty times.
inline Words without_names(const Words& words)
{
    Words kept(words.begin(), words.begin() + 5);
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
        if (const std::uint32_t op = words[at] & 0xffff; op != 5 && op != 6)
            kept.insert(kept.end(), words.begin() + static_cast<std::ptrdiff_t>(at),
                        words.begin() + static_cast<std::ptrdiff_t>(at + (words[at] >> 16)));
    return kept;
}

inline bool validator_is_there()
{
    return std::system("spirv-val --version > /dev/null 2>&1") == 0;
}

// A stage under these constants, and with the numbers of plain_material(), is smaller and valid.
inline void check_pruned(const char* name, const Words& whole, const std::vector<std::int32_t>& constants)
{
    const std::string path = (std::filesystem::temp_directory_path() / ("burnish_prune_" + std::to_string(::getpid()) + ".spv")).string();
    for (const bool known : {false, true}) {
        Words words = pruned(whole, constants, known ? known_numbers({}, {plain_material()}) : std::vector<KnownNumber>());
        EXPECT_LT(words.size(), whole.size()) << name << ": not understood";
        words = without_names(words);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(words[0])));
        EXPECT_EQ(std::system(("spirv-val --target-env vulkan1.3 '" + path + "'").c_str()), 0) << name << (known ? ", numbers known" : "");
    }
    std::filesystem::remove(path);
}

} // namespace burnish::test
