#include "shading/bake/ltc/table.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <iterator>

#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/math/scalar_math.h"
#include "core/simd/half.h"
#include "shading/bake/ltc/npy.h"

namespace burnish::ltc {
namespace {

static_assert(std::endian::native == std::endian::little, "tables are little-endian");
constexpr char kMagic[8] = {'b', 'n', 'l', 't', 'c', '0', '1', '\n'};

struct Header {
    char magic[8];
    std::uint32_t version, size, flags, channels, beyond, zero;
};
static_assert(sizeof(Header) == 32);
constexpr std::uint32_t kMadeFlags = kNormMask | kUnaligned | kUnsymmetric | kLobeMask;
constexpr std::uint32_t kFlags = kRootAlpha | kHalf | kBasisMask | kOverAlpha | kRound | kInverse | kMadeFlags;

Matrix matrix_of(const float* entry)
{
    Matrix m;
    for (std::size_t e = 0; e < 9; ++e)
        m[e] = static_cast<double>(entry[e]);
    return m;
}

std::string entry_name(const Grid& grid, std::size_t node)
{
    const std::array<int, 4> i = grid.indices(node);
    return fmt::format("entry [theta {}][phi {}][alpha {}][lambda {}]", i[0], i[1], i[2], i[3]);
}

} // namespace

Table make_table(const Grid& grid, const std::vector<Matrix>& entries, const std::vector<Albedo>& albedos, std::uint32_t made)
{
    BN_CHECK(entries.size() == grid.nodes() && albedos.size() == grid.nodes());
    Table table = {grid, made, {}};
    for (std::size_t node = 0; node < entries.size(); ++node) {
        const Mask zero = made & (kUnsymmetric | kUnaligned) ? 0 : grid.zero(node);
        for (std::size_t e = 0; e < 9; ++e) // rounding moves elements that symmetry makes zero
            table.entries.push_back(zero >> e & 1u ? 0.0f : static_cast<float>(entries[node][e]));
        table.entries.push_back(static_cast<float>(albedos[node].all));
        table.entries.push_back(static_cast<float>(albedos[node].grazing));
    }
    return table;
}

Looked lookup(const Table& table, const Place& of)
{
    Place place = of;
    if (table.grid.round)
        place = {of.theta, 0.0, of.alpha * std::sqrt(of.lambda), 1.0};
    double sum[kChannels] = {};
    for (const Corner& corner : table.grid.corners(place))
        for (std::size_t c = 0; c < kChannels; ++c)
            sum[c] += corner.weight * static_cast<double>(table.entries[kChannels * corner.node + c]);
    Matrix entry;
    for (std::size_t e = 0; e < 9; ++e)
        entry[e] = sum[e];
    Matrix m = table.grid.shown(entry, place);
    if (table.grid.round) {
        const double c = det_cos(of.phi), s = det_sin(of.phi);
        m = Matrix{c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0} * m;
    }
    return {m, sum[9], sum[10]};
}

std::vector<std::uint16_t> table_texels(const Table& table)
{
    const bool round = table.grid.round;
    BN_CHECK(table.grid.size == (round ? kShadingRoundSize : kShadingSize));
    constexpr std::size_t kOfRound[] = {0, 4, 6, 2, 8, 9, 10}, kOfAll[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    const std::size_t nodes = table.grid.nodes(), planes = round ? 2 : 3, channels = round ? std::size(kOfRound) : std::size(kOfAll);
    std::vector<std::uint16_t> texels(planes * 4 * nodes, 0);
    for (std::size_t node = 0; node < nodes; ++node) {
        const float* entry = &table.entries[kChannels * node];
        for (std::size_t c = 0; c < channels; ++c)
            texels[4 * (c / 4 * nodes + node) + c % 4] = float_to_half(entry[round ? kOfRound[c] : kOfAll[c]]);
    }
    return texels;
}

std::vector<std::uint8_t> table_bytes(const Table& table, bool half)
{
    Header h = {};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.version = kTableVersion, h.size = static_cast<std::uint32_t>(table.grid.size), h.channels = kChannels;
    h.beyond = static_cast<std::uint32_t>(table.grid.beyond);
    h.flags = (table.grid.root_alpha ? kRootAlpha : 0u) | (table.grid.over_alpha ? kOverAlpha : 0u) | (table.grid.round ? kRound : 0u) |
              (table.grid.inverse ? kInverse : 0u) | static_cast<std::uint32_t>(table.grid.basis) << kBasisShift | (half ? kHalf : 0u) |
              table.made;
    std::vector<std::uint8_t> bytes(sizeof h);
    std::memcpy(bytes.data(), &h, sizeof h);
    const auto append = [&bytes](const auto& value) {
        const std::size_t at = bytes.size();
        bytes.resize(at + sizeof value);
        std::memcpy(bytes.data() + at, &value, sizeof value);
    };
    for (float value : table.entries)
        if (half)
            append(float_to_half(value));
        else
            append(value);
    append(hash_bytes(bytes.data(), bytes.size()));
    return bytes;
}

Result<Table> parse_table(const std::uint8_t* data, std::size_t bytes, const std::string& path, int size)
{
    const auto refuse = [&](const std::string& place, const std::string& reason) {
        return Error{ExitCode::bad_input, path, place, reason};
    };
    if (is_npy(data, bytes))
        return parse_npy(data, bytes, path, size);
    Header h;
    if (bytes < sizeof h || std::memcmp(data, kMagic, sizeof kMagic) != 0)
        return refuse("byte 0", "is not a table of transformed cosines");
    std::memcpy(&h, data, sizeof h);
    if (h.version != kTableVersion)
        return refuse("byte 8", fmt::format("has version {}, this program reads version {}", h.version, kTableVersion));
    const int most = h.flags & kRound ? kMostRoundSize : kMostSize;
    if (h.size < kLeastSize || h.size > static_cast<std::uint32_t>(most))
        return refuse("byte 12", fmt::format("has {} nodes along an axis, which must be {} to {}", h.size, kLeastSize, most));
    if (size != 0 && h.size != static_cast<std::uint32_t>(size))
        return refuse("byte 12", fmt::format("has {} nodes along an axis, {} are asked for", h.size, size));
    if ((h.flags & ~kFlags) != 0 || (h.flags & kBasisMask) == kBasisMask || (h.flags & kNormMask) == kNormMask)
        return refuse("byte 16", fmt::format("has flags {:#x}, of which some are not known", h.flags));
    if (h.channels != kChannels)
        return refuse("byte 20", fmt::format("has {} channels, which must be {}", h.channels, kChannels));
    if (h.beyond > h.size || h.zero != 0)
        return refuse("byte 24", fmt::format("has {} nodes of alpha beyond 1, which must be at most {}", h.beyond, h.size));
    Table table;
    table.made = h.flags & kMadeFlags;
    table.grid.size = static_cast<int>(h.size), table.grid.beyond = static_cast<int>(h.beyond);
    table.grid.over_alpha = (h.flags & kOverAlpha) != 0, table.grid.round = (h.flags & kRound) != 0;
    table.grid.inverse = (h.flags & kInverse) != 0;
    table.grid.root_alpha = (h.flags & kRootAlpha) != 0, table.grid.basis = static_cast<Basis>((h.flags & kBasisMask) >> kBasisShift);
    const bool half = (h.flags & kHalf) != 0;
    const std::size_t values = table.grid.nodes() * kChannels, width = half ? 2 : 4, whole = sizeof h + values * width + 8;
    if (bytes != whole)
        return refuse(fmt::format("byte {}", std::min(bytes, whole)), fmt::format("has {} bytes, which must be {}", bytes, whole));
    std::uint64_t hash = 0;
    std::memcpy(&hash, data + whole - 8, sizeof hash);
    if (hash != hash_bytes(data, whole - 8))
        return refuse(fmt::format("byte {}", whole - 8), "is damaged: its hash is another one");
    table.entries.resize(values);
    for (std::size_t i = 0; i < values; ++i) {
        if (half) {
            std::uint16_t value = 0;
            std::memcpy(&value, data + sizeof h + 2 * i, 2);
            table.entries[i] = half_to_float(value);
        } else {
            std::memcpy(&table.entries[i], data + sizeof h + 4 * i, 4);
        }
        if (!std::isfinite(table.entries[i]))
            return refuse(entry_name(table.grid, i / kChannels), fmt::format("channel {} is not finite", i % kChannels));
    }
    for (std::size_t node = 0; node < table.grid.nodes(); ++node)
        if (!(determinant(matrix_of(&table.entries[kChannels * node])) > 0.0))
            return refuse(entry_name(table.grid, node), "has no positive determinant");
    return table;
}

Result<Table> read_table(const std::string& path, int size)
{
    constexpr std::uint64_t kMostBytes = 80u << 20; // 32 nodes along an axis
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostBytes);
    BN_TRY(bytes);
    return parse_table(bytes->data(), bytes->size(), path, size);
}

Status write_table(const std::string& path, const Table& table, bool half)
{
    const std::vector<std::uint8_t> bytes = table_bytes(table, half);
    return write_file_atomic(path, bytes.data(), bytes.size());
}

} // namespace burnish::ltc
