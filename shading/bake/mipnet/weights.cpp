#include "shading/bake/mipnet/weights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/simd/half.h"

namespace burnish::mipnet {
namespace {

static_assert(std::endian::native == std::endian::little, "weights are little-endian");
constexpr char kWeightsMagic[8] = {'b', 'n', 'm', 'i', 'p', '0', '1', '\n'};
constexpr std::uint32_t kMostText = 4096, kFar = 2; // flag in the layout

struct WeightsHeader {
    char magic[8];
    std::uint32_t version, lobe, layout, channels, layers_a, width_a, layers_b, width_b, numbers, text;
    std::uint64_t seed, steps, data;
    float leak;
    std::uint32_t zero;
};
static_assert(sizeof(WeightsHeader) == 80);

} // namespace

std::uint64_t net_hash(const Weights& w)
{
    const std::int32_t shape[] = {static_cast<std::int32_t>(w.shape.lobe),
                                  static_cast<std::int32_t>(w.shape.layout),
                                  w.shape.a.layers,
                                  w.shape.a.width,
                                  w.shape.b.layers,
                                  w.shape.b.width};
    if (w.shape.far)
        return hash_bytes(w.numbers.data(), w.numbers.size() * sizeof(float), hash_bytes(shape, sizeof shape) + 1);
    return hash_bytes(w.numbers.data(), w.numbers.size() * sizeof(float), hash_bytes(shape, sizeof shape));
}

std::vector<std::uint8_t> weights_bytes(const Weights& w)
{
    const std::string text = w.families + "\n" + w.command;
    WeightsHeader h = {};
    std::memcpy(h.magic, kWeightsMagic, sizeof kWeightsMagic);
    h.version = kWeightsVersion, h.lobe = static_cast<std::uint32_t>(w.shape.lobe);
    h.layout = static_cast<std::uint32_t>(w.shape.layout) | (w.shape.far ? kFar : 0u), h.channels = kChannels;
    h.layers_a = static_cast<std::uint32_t>(w.shape.a.layers), h.width_a = static_cast<std::uint32_t>(w.shape.a.width);
    h.layers_b = static_cast<std::uint32_t>(w.shape.b.layers), h.width_b = static_cast<std::uint32_t>(w.shape.b.width);
    h.numbers = static_cast<std::uint32_t>(w.numbers.size()), h.text = static_cast<std::uint32_t>(text.size());
    h.seed = w.seed, h.steps = w.steps, h.data = w.data, h.leak = kLeak;
    std::vector<std::uint8_t> bytes(sizeof h + text.size() + 2 * w.numbers.size() + 8);
    std::memcpy(bytes.data(), &h, sizeof h);
    std::memcpy(bytes.data() + sizeof h, text.data(), text.size());
    std::uint8_t* at = bytes.data() + sizeof h + text.size();
    for (float number : w.numbers) {
        const std::uint16_t half = float_to_half(number);
        std::memcpy(at, &half, 2);
        at += 2;
    }
    const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size() - 8);
    std::memcpy(at, &hash, sizeof hash);
    return bytes;
}

Result<Weights> parse_weights(const std::uint8_t* data, std::size_t bytes, const std::string& path)
{
    const auto refuse = [&](std::size_t byte, const std::string& reason) {
        return Error{ExitCode::bad_input, path, fmt::format("byte {}", byte), reason};
    };
    WeightsHeader h;
    if (bytes < sizeof h || std::memcmp(data, kWeightsMagic, sizeof kWeightsMagic) != 0)
        return refuse(0, "is not weights of a mipmap net");
    std::memcpy(&h, data, sizeof h);
    if (h.version != kWeightsVersion)
        return refuse(8, fmt::format("has version {}, this program reads version {}", h.version, kWeightsVersion));
    if (h.lobe > 2)
        return refuse(12, fmt::format("is of lobe {}, which is none of 0, 1 and 2", h.lobe));
    if (h.layout > (h.layers_b == 0 ? 1u : 1u | kFar))
        return refuse(16, fmt::format("has layout {}, which its nets cannot have", h.layout));
    if (h.channels != kChannels)
        return refuse(20, fmt::format("has {} channels, which must be {}", h.channels, kChannels));
    const bool alone = h.layers_b == 0 && h.width_b == 0; // H_A alone
    for (const std::uint32_t layers : {h.layers_a, alone ? 1 : h.layers_b})
        if (layers < 1 || layers > kMostHidden)
            return refuse(24, fmt::format("has {} hidden layers, which must be 1 to {}", layers, kMostHidden));
    for (const std::uint32_t width : {h.width_a, alone ? 1 : h.width_b})
        if (width < 1 || width > kMostWidth)
            return refuse(28, fmt::format("has hidden layers of {} units, which must be 1 to {}", width, kMostWidth));
    if (!(h.leak == kLeak) || h.zero != 0)
        return refuse(72, "has another slope of hidden units than this program's");
    Weights w;
    w.shape.lobe = static_cast<Lobe>(h.lobe), w.shape.layout = static_cast<Layout>(h.layout & ~kFar), w.shape.far = (h.layout & kFar) != 0;
    w.shape.a = {static_cast<int>(h.layers_a), static_cast<int>(h.width_a)};
    w.shape.b = {static_cast<int>(h.layers_b), static_cast<int>(h.width_b)};
    const std::size_t count = plan_of(w.shape).count, whole = sizeof h + h.text + 2 * count + 8;
    if (h.text > kMostText || h.numbers != count)
        return refuse(40, fmt::format("has {} numbers, its nets have {}", h.numbers, count));
    if (bytes != whole)
        return refuse(std::min(bytes, whole), fmt::format("has {} bytes, which must be {}", bytes, whole));
    std::uint64_t hash = 0;
    std::memcpy(&hash, data + whole - 8, sizeof hash);
    if (hash != hash_bytes(data, whole - 8))
        return refuse(whole - 8, "is damaged: its hash is another one");
    w.seed = h.seed, w.steps = h.steps, w.data = h.data;
    const std::string text(reinterpret_cast<const char*>(data) + sizeof h, h.text);
    const std::size_t line = text.find('\n');
    w.families = text.substr(0, line);
    w.command = line == std::string::npos ? "" : text.substr(line + 1);
    w.numbers.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint16_t half = 0;
        std::memcpy(&half, data + sizeof h + h.text + 2 * i, 2);
        w.numbers[i] = half_to_float(half);
        if (!std::isfinite(w.numbers[i]))
            return refuse(sizeof h + h.text + 2 * i, "is not finite");
    }
    return w;
}

Result<Weights> read_weights(const std::string& path)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, std::uint64_t{256} << 20);
    BN_TRY(bytes);
    return parse_weights(bytes->data(), bytes->size(), path);
}

Status write_weights(const std::string& path, const Weights& weights)
{
    const std::vector<std::uint8_t> bytes = weights_bytes(weights);
    return write_file_atomic(path, bytes.data(), bytes.size());
}

} // namespace burnish::mipnet
