// libFuzzer entry: any bytes as an image, checked by our header guard alone. No library sees them.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/check.h"
#include "core/image/io/guard.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const burnish::Result<burnish::ImageProbe> probe = burnish::probe_image({data, size, "fuzz"}, {});
    if (probe)
        BN_CHECK(!std::string(probe->format).empty() && probe->subimage >= 0);
    else
        BN_CHECK(!probe.error().reason.empty());
    return 0;
}
