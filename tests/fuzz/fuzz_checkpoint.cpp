// libFuzzer entry: any bytes as the checkpoint of a reference image. An odd first byte sets the right key and checksum; its next
// two bits are the number of sums.
#include <cmath>

#include "core/base/check.h"
#include "raster/reference/checkpoint.h"
#include "tests/fuzz/sealed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr int kWidth = 16, kHeight = 8;
    constexpr std::uint64_t kKey = 0x6275726e69736821;
    constexpr std::size_t kHeader = 32, kKeyAt = 8, kHashAt = 24;
    if (size == 0)
        return 0;
    Accumulator a(kWidth, kHeight);
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    const bool sealed = data[0] & 1;
    if (sealed) {
        const std::size_t pixels = static_cast<std::size_t>(kWidth) * kHeight;
        const std::size_t sums = data[0] >> 1 & 3u;
        bytes.resize(kHeader + a.passes.size() * sizeof(std::uint32_t) + sums * pixels * sizeof(PixelState));
        std::memcpy(bytes.data() + kKeyAt, &kKey, sizeof(kKey));
        seal(bytes, kHeader, bytes.size(), kHashAt);
    }
    const Status read = parse_checkpoint(bytes.data(), bytes.size(), "fuzz", kKey, a);
    BN_CHECK(!read || sealed);
    if (!read) {
        BN_CHECK(!read.error().reason.empty() && most_passes(a) == 0);
        return 0;
    }
    BN_CHECK(least_passes(a) <= most_passes(a));
    BN_CHECK(mean_image(a).width == kWidth && variance_image(a).height == kHeight);
    BN_CHECK(std::isnan(mean_relative_error(a)) || mean_relative_error(a) >= 0.0);
    return 0;
}
