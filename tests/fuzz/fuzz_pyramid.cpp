// libFuzzer entry: any bytes as a material's mip levels, in the format that `burnish bake mip` and the cache write. An odd first byte sets
// the right checksum.
#include <algorithm>

#include "core/base/check.h"
#include "shading/bake/mip/pyramid_file.h"
#include "tests/fuzz/sealed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr std::size_t kHash = 8;
    if (size == 0)
        return 0;
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    if (data[0] & 1 && bytes.size() >= kHash)
        seal(bytes, 0, bytes.size() - kHash, bytes.size() - kHash);
    const Result<MipFile> read = parse_mip_file(bytes, "fuzz");
    if (!read) {
        BN_CHECK(!read.error().reason.empty());
        return 0;
    }
    MipParts written;
    for (const MipLevels& levels : read->materials) {
        written.materials.push_back(&levels);
        BN_CHECK(!levels.levels.empty() || (levels.width == 1 && levels.height == 1));
        for (const MipLevel& level : levels.levels)
            BN_CHECK(level.texels.size() == static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
    }
    for (const MapLevels& map : read->maps) {
        BN_CHECK(!map.levels.empty() || (map.width == 1 && map.height == 1));
        for (std::size_t l = 0; l < map.levels.size(); ++l)
            BN_CHECK(map.levels[l].size() == static_cast<std::size_t>(std::max(1, map.width >> (l + 1))) *
                                                 static_cast<std::size_t>(std::max(1, map.height >> (l + 1))) *
                                                 static_cast<std::size_t>(map.channels));
    }
    written.map_count = read->maps.size(), written.map = [&](std::size_t i) { return read->maps[i]; };
    BN_CHECK(mip_file_bytes(written).size() == bytes.size());
    return 0;
}
