// libFuzzer entry: any bytes as the checkpoint for a table bake (even first byte) or a training (odd first byte). This byte's second bit
// sets the right key, length and checksum.
#include <cmath>

#include "core/base/check.h"
#include "shading/lab/ltc/bake_checkpoint.h"
#include "shading/lab/mipnet/training_checkpoint.h"
#include "tests/fuzz/sealed.h"

namespace {

constexpr std::uint64_t kKey = 0x6275726e69736821;
constexpr std::size_t kMagic = 8, kHash = 8, kNumbers = 3, kSteps = 4;

void complete(std::vector<std::uint8_t>& bytes, std::size_t size)
{
    bytes.resize(size);
    std::memcpy(bytes.data() + kMagic, &kKey, sizeof kKey);
    seal(bytes, 0, size - kHash, size - kHash);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    if (size == 0)
        return 0;
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    const bool sealed = data[0] & 2;
    if (data[0] & 1) {
        mipnet::Trained t;
        for (std::vector<float>* numbers : {&t.numbers, &t.first, &t.second, &t.mean})
            numbers->assign(kNumbers, 1.0f);
        if (sealed)
            complete(bytes, kMagic + 16 + 4 * kNumbers * sizeof(float) + kHash);
        const Status read = mipnet::parse_training_checkpoint(bytes, "fuzz", kKey, kSteps, t);
        BN_CHECK(read || (!read.error().reason.empty() && t.step == 0 && t.numbers[0] == 1.0f));
        BN_CHECK(t.step <= kSteps && t.numbers.size() == kNumbers && std::isfinite(t.mean[0]));
        BN_CHECK(!read || mipnet::training_checkpoint_bytes(kKey, t) == bytes);
        return 0;
    }
    ltc::Grid grid;
    grid.size = 2, grid.beyond = 0, grid.round = true;
    ltc::BakeProgress p(grid);
    if (sealed && bytes.size() > 4 * 8) {
        const bool begun = bytes[4 * 8] & 1;
        std::memset(bytes.data() + 4 * 8, 0, std::min<std::size_t>(8, bytes.size() - 4 * 8));
        bytes[4 * 8] = begun;
        const std::size_t head = kMagic + 4 * sizeof(std::uint64_t) + 3 * sizeof(double);
        complete(bytes, head + grid.nodes() * (sizeof(double) + (begun ? 2 : 1) * sizeof(ltc::Matrix)) + kHash);
    }
    const Status read = ltc::parse_bake_checkpoint(bytes, "fuzz", kKey, kSteps, p);
    BN_CHECK(read || (!read.error().reason.empty() && p.chains == 0 && p.state.entries.empty()));
    BN_CHECK(p.chains <= p.all_chains && p.steps <= kSteps && p.nodes.size() == grid.nodes());
    BN_CHECK(!read || ltc::bake_checkpoint_bytes(kKey, p).size() == bytes.size());
    return 0;
}
