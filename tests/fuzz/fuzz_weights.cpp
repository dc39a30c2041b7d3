// libFuzzer entry: any bytes as the weights of a mipmap net. An odd first byte sets the right length and checksum.
#include <cmath>

#include "core/base/check.h"
#include "shading/bake/mipnet/weights.h"
#include "tests/fuzz/sealed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr std::size_t kHeader = 80, kShape = 24, kNumbers = 40, kText = 44, kHash = 8;
    if (size == 0)
        return 0;
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    const bool sealed = data[0] & 1 && bytes.size() >= kHeader;
    if (sealed) {
        std::uint32_t shape[4]; // hidden layers and their width, twice
        std::memcpy(shape, bytes.data() + kShape, sizeof shape);
        for (std::uint32_t& side : shape)
            side %= 5;
        std::memcpy(bytes.data() + kShape, shape, sizeof shape);
        mipnet::Shape planned;
        planned.lobe = static_cast<mipnet::Lobe>(bytes[12] % 3), planned.layout = static_cast<mipnet::Layout>(bytes[16] % 2);
        planned.far = bytes[16] & 2;
        planned.a = {static_cast<int>(shape[0]), static_cast<int>(shape[1])};
        planned.b = {static_cast<int>(shape[2]), static_cast<int>(shape[3])};
        const bool planable = shape[0] && shape[1] && !shape[2] == !shape[3];
        const std::uint32_t numbers = planable ? static_cast<std::uint32_t>(mipnet::plan_of(planned).count) : 0, text = bytes[kText] % 64;
        std::memcpy(bytes.data() + kNumbers, &numbers, sizeof numbers);
        std::memcpy(bytes.data() + kText, &text, sizeof text);
        const std::size_t used = bytes.size();
        bytes.resize(kHeader + text + 2 * numbers + kHash);
        for (std::size_t i = used; i < bytes.size() && used > kHeader; ++i) // repeats the bytes
            bytes[i] = bytes[kHeader + (i - kHeader) % (used - kHeader)];
        seal(bytes, 0, bytes.size() - kHash, bytes.size() - kHash);
    }
    const Result<mipnet::Weights> weights = mipnet::parse_weights(bytes.data(), bytes.size(), "fuzz");
    if (!weights) {
        BN_CHECK(!weights.error().reason.empty());
        return 0;
    }
    BN_CHECK(weights->numbers.size() == mipnet::plan_of(weights->shape).count);
    for (const float number : weights->numbers)
        BN_CHECK(std::isfinite(number));
    if (weights->command.find('\n') == std::string::npos) // each text is written as read
        BN_CHECK(mipnet::weights_bytes(*weights).size() <= bytes.size() + 1);
    return 0;
}
