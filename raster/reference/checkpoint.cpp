#include "raster/reference/checkpoint.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

constexpr char kMagic[8] = {'B', 'N', 'R', 'E', 'F', '0', '2', '\n'};
constexpr std::size_t kVersionAt = 5; // in a magic

struct Header { // then each block's passes as 32 bits, then the picture's sums, the smallest first
    char magic[8];
    std::uint64_t key;
    std::int32_t width, height;
    std::uint64_t content_hash; // over all later bytes
};

std::size_t picture_size(const Accumulator& a)
{
    return static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height) * sizeof(PixelState);
}

std::size_t body_size(const Accumulator& a, std::uint32_t bits)
{
    return a.passes.size() * sizeof(std::uint32_t) + static_cast<std::size_t>(std::popcount(bits)) * picture_size(a);
}

// Calls `use` for each bit that is set, the lowest first.
template <class Use> void each_bit(std::uint32_t bits, const Use& use)
{
    for (std::size_t k = 0; k < kMostSums; ++k)
        if (bits >> k & 1u)
            use(k);
}

} // namespace

Status write_checkpoint(const std::string& path, std::uint64_t key, const Accumulator& a, Links links)
{
    const std::uint32_t bits = bits_of_passes(a);
    std::vector<std::uint8_t> bytes(sizeof(Header) + body_size(a, bits));
    std::uint8_t* const body = bytes.data() + sizeof(Header);
    const std::size_t passes = a.passes.size() * sizeof(std::uint32_t);
    std::memcpy(body, a.passes.data(), passes);
    std::uint8_t* at = body + passes;
    each_bit(bits, [&](std::size_t k) {
        std::memcpy(at, a.sums[k].data(), picture_size(a));
        at += picture_size(a);
    });
    Header h = {};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.key = key, h.width = a.width, h.height = a.height;
    h.content_hash = hash_bytes(body, body_size(a, bits));
    std::memcpy(bytes.data(), &h, sizeof h);
    return write_file_atomic(path, bytes.data(), bytes.size(), links);
}

Status parse_checkpoint(const std::uint8_t* data, std::size_t size, const std::string& path, std::uint64_t key, Accumulator& into)
{
    const auto refuse = [&](const char* reason) { return Error{ExitCode::bad_input, path, "", reason}; };
    Header h;
    if (size < sizeof h || std::memcmp(data, kMagic, kVersionAt) != 0)
        return refuse("is not a checkpoint of a reference picture");
    if (std::memcmp(data, kMagic, sizeof kMagic) != 0)
        return refuse("is a checkpoint of another version of burnish, which sums in another order; remove it");
    std::memcpy(&h, data, sizeof h);
    if (h.width != into.width || h.height != into.height || h.key != key)
        return refuse("is a checkpoint of another picture: scene, environment, view or options differ");
    const std::uint8_t* body = data + sizeof h;
    const std::size_t passes = into.passes.size() * sizeof(std::uint32_t);
    if (size < sizeof h + passes)
        return refuse("is a damaged checkpoint");
    Column<std::uint32_t> read(into.passes.size());
    std::memcpy(read.data(), body, passes);
    const std::uint32_t bits = std::accumulate(read.begin(), read.end(), 0u, std::bit_or<>());
    if (size != sizeof h + body_size(into, bits) || hash_bytes(body, body_size(into, bits)) != h.content_hash)
        return refuse("is a damaged checkpoint");
    into.passes = std::move(read);
    free_sums(into);
    reserve_sums(into, bits);
    body += passes;
    each_bit(bits, [&](std::size_t k) {
        std::memcpy(into.sums[k].data(), body, picture_size(into));
        body += picture_size(into);
    });
    return {};
}

namespace {

constexpr char kBlocksMagic[8] = {'B', 'N', 'B', 'L', 'K', '0', '2', '\n'};

struct BlocksHeader { // then the states of each block's pixels, row by row: sum after sum, the largest, which has the first passes, first
    char magic[8];
    std::uint64_t key;
    std::int32_t width, height;
    std::uint32_t first, count;       // blocks
    std::uint32_t first_pass, passes; // of each block
};

// Calls `use` for each row in a block's pixels: the first pixel's index, the pixel count.
template <class Use> void each_row(const Accumulator& a, std::size_t index, const Use& use)
{
    const PixelBlock block = block_of(a, index, 0);
    for (int y = 0; y < block.height; ++y)
        use(static_cast<std::size_t>(block.y0 + y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(block.x0) -
                block.first_pixel,
            static_cast<std::size_t>(block.width));
}

} // namespace

std::vector<std::uint8_t> blocks_of(const Accumulator& a, std::uint64_t key, std::uint32_t first, std::uint32_t count)
{
    BN_CHECK(count > 0 && std::uint64_t{first} + count <= a.passes.size());
    std::vector<std::uint8_t> bytes;
    const auto put = [&](const void* data, std::size_t size) {
        const std::size_t at = bytes.size();
        bytes.resize(at + size);
        std::memcpy(bytes.data() + at, data, size);
    };
    BlocksHeader h = {};
    std::memcpy(h.magic, kBlocksMagic, sizeof h.magic);
    h.key = key, h.width = a.width, h.height = a.height, h.first = first, h.count = count;
    h.first_pass = a.first_pass, h.passes = a.passes[first];
    put(&h, sizeof h);
    for (std::size_t i = first; i < std::size_t{first} + count; ++i) {
        BN_CHECK(a.passes[i] == h.passes);
        for (std::size_t k = kMostSums; k-- > 0;)
            if (h.passes >> k & 1u)
                each_row(a, i, [&](std::size_t pixel, std::size_t width) { put(&a.sums[k][pixel], width * sizeof(PixelState)); });
    }
    return bytes;
}

namespace {

// Adds a sum over 2^k passes to a block's pixels. Allocates the sums that the block then has. from: the pixels' states.
void add_to_block(Accumulator& into, std::size_t index, int k, const std::uint8_t* from)
{
    const std::uint32_t passes = into.passes[index], then = passes + (1u << k);
    reserve_sums(into, then);
    each_row(into, index, [&](std::size_t pixel, std::size_t width) {
        for (std::size_t i = pixel; i < pixel + width; ++i, from += sizeof(PixelState)) {
            PixelState own[kMostSums], next;
            std::memcpy(&next, from, sizeof next);
            each_bit(passes, [&](std::size_t bit) { own[bit] = into.sums[bit][i]; });
            add_sum(own, passes, k, next);
            each_bit(then, [&](std::size_t bit) { into.sums[bit][i] = own[bit]; });
        }
    });
    into.passes[index] = then;
}

} // namespace

Status take_blocks(const std::vector<std::uint8_t>& bytes, std::uint64_t key, Accumulator& into)
{
    const auto refuse = [](const char* reason) { return Error{ExitCode::bad_input, "", "", reason}; };
    BlocksHeader h;
    if (bytes.size() < sizeof h || std::memcmp(bytes.data(), kBlocksMagic, sizeof h.magic) != 0)
        return refuse("is no part of a reference picture");
    std::memcpy(&h, bytes.data(), sizeof h);
    if (h.width != into.width || h.height != into.height || h.key != key || std::uint64_t{h.first} + h.count > into.passes.size())
        return refuse("is part of another picture: scene, environment, view or options differ");
    // Check the whole part first
    std::size_t pixels = 0;
    for (std::size_t i = h.first; i < std::size_t{h.first} + h.count; ++i) {
        if (into.passes[i] != h.first_pass - into.first_pass)
            return refuse("is a part whose passes do not follow the passes before it");
        each_row(into, i, [&](std::size_t, std::size_t width) { pixels += width; });
    }
    // A sum over 2^k passes is a tree node only behind a multiple of 2^k passes
    const std::uint32_t largest = std::bit_floor(h.passes);
    if (h.passes == 0 || (h.first_pass - into.first_pass) % largest != 0 || h.first_pass + h.passes < h.first_pass ||
        bytes.size() != sizeof h + pixels * static_cast<std::size_t>(std::popcount(h.passes)) * sizeof(PixelState))
        return refuse("is a damaged part of a picture");
    // Add its sums
    const std::uint8_t* from = bytes.data() + sizeof h;
    for (std::size_t i = h.first; i < std::size_t{h.first} + h.count; ++i)
        for (int k = kMostSums; k-- > 0;)
            if (h.passes >> k & 1u) {
                add_to_block(into, i, k, from);
                each_row(into, i, [&](std::size_t, std::size_t width) { from += width * sizeof(PixelState); });
            }
    return {};
}

Result<bool> read_checkpoint(const std::string& path, std::uint64_t key, Accumulator& into, Links links)
{
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(path, ignored)))
        return false;
    if (links == Links::follow && std::filesystem::status(path, ignored).type() == std::filesystem::file_type::not_found)
        return false; // a link to a file that is not there yet
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, std::uint64_t{1} << 40, links);
    BN_TRY(bytes);
    BN_TRY(parse_checkpoint(bytes->data(), bytes->size(), path, key, into));
    return true;
}

} // namespace burnish
