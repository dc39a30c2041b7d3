// libFuzzer entry: any bytes as a baked environment in the cache. An odd first byte sets the right checksums, and its second bit requests
// extracted lights.
#include <cmath>

#include "core/base/check.h"
#include "shading/bake/environment/cube_map.h"
#include "shading/bake/environment/environment_cache.h"
#include "tests/fuzz/sealed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr int kSize = 4, kLevels = 2;
    constexpr std::uint64_t kContent = 0x6275726e69736821;
    constexpr std::size_t kHeader = 536, kContentHash = 512, kPayloadHash = 520, kHeaderHash = 528;
    if (size == 0)
        return 0;
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    const bool sealed = data[0] & 1;
    if (sealed) {
        std::size_t texels = make_cube_map(kSize, kLevels, 1.0f).texels.size() + make_cube_map(kIrradianceSize, 1, 1.0f).texels.size();
        if (data[0] & 2)
            texels += make_cube_map(kSize, 1, 1.0f).texels.size();
        bytes.resize(kHeader + texels * sizeof(std::uint16_t));
        std::memcpy(bytes.data() + kContentHash, &kContent, sizeof(kContent));
        seal(bytes, kHeader, bytes.size(), kPayloadHash);
        seal(bytes, 0, kHeaderHash, kHeaderHash);
    }
    const std::optional<Environment> found = parse_environment_cache(bytes.data(), bytes.size(), kContent, kSize, kLevels);
    BN_CHECK(!found || sealed);
    if (found)
        for (const float figure : {found->specular.scale, found->irradiance.scale, found->whole.scale, found->peak_source})
            BN_CHECK(std::isfinite(figure) && found->content_hash == kContent &&
                     found->extracted_lights.empty() == found->whole.texels.empty());
    return 0;
}
