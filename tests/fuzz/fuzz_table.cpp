// libFuzzer entry: any bytes as a table of transformed cosines. An odd first byte sets the right length and checksum.
#include <cmath>

#include "core/base/check.h"
#include "shading/bake/ltc/npy.h"
#include "shading/bake/ltc/table.h"
#include "tests/fuzz/sealed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    constexpr std::size_t kHeader = 32, kSizeAt = 12, kHash = 8;
    if (size == 0)
        return 0;
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    const bool sealed = data[0] & 1 && bytes.size() >= kHeader;
    if (sealed) {
        const bool half = bytes[16] & ltc::kHalf, round = bytes[16] & ltc::kRound;
        bytes[kSizeAt] = 2; // nodes along an axis
        ltc::Grid grid;
        grid.size = 2, grid.beyond = std::min<int>(bytes[24], 2), grid.round = round;
        const std::size_t used = bytes.size();
        bytes.resize(kHeader + grid.nodes() * ltc::kChannels * (half ? 2 : 4) + kHash);
        for (std::size_t i = used; i < bytes.size() && used > kHeader; ++i) // repeats the bytes
            bytes[i] = bytes[kHeader + (i - kHeader) % (used - kHeader)];
        seal(bytes, 0, bytes.size() - kHash, bytes.size() - kHash);
    }
    const Result<ltc::Table> table = ltc::parse_table(bytes.data(), bytes.size(), "fuzz", 0);
    if (!table) {
        BN_CHECK(!table.error().reason.empty());
        return 0;
    }
    BN_CHECK((sealed || ltc::is_npy(bytes.data(), bytes.size())) && table->entries.size() == table->grid.nodes() * ltc::kChannels);
    for (const double theta : {0.0, 0.7, 1.5})
        for (const double alpha : {0.001, 0.3, 1.0}) {
            const ltc::Looked looked = ltc::lookup(*table, {theta, 0.4, alpha, 0.5});
            BN_CHECK(!std::isnan(looked.all) && !std::isnan(looked.grazing));
        }
    return 0;
}
