// libFuzzer entry: any bytes as an OpenEXR file, the format with the largest header. The entry corrects the first bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/io/image_library.h"
#include "tests/fuzz/decode.h"

// Loads the image library's hundreds of files before a run's clock starts.
extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    static_cast<void>(static_cast<bool>(burnish::image_library("fuzz")));
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01, 2};
    std::vector<std::uint8_t> bytes(data, data + size);
    std::copy_n(kMagic, std::min(size, sizeof(kMagic)), bytes.begin());
    decode_and_check(bytes.data(), bytes.size());
    return 0;
}
