// libFuzzer entry: any bytes as an image of any format, guarded and decoded.
#include <cstddef>
#include <cstdint>

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
    decode_and_check(data, size);
    return 0;
}
