#include "raster/reference/checkpoint.h"

#include <cstring>
#include <filesystem>
#include <vector>

#include "core/base/check.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

constexpr char kMagic[8] = {'B', 'N', 'R', 'E', 'F', '0', '1', '\n'};

struct Header {
    char magic[8];
    std::uint64_t key;
    std::int32_t width, height;
    std::uint64_t content_hash; // of all later bytes
};

std::size_t body_size(const Accumulator& a)
{
    return a.passes.size() * sizeof(std::uint32_t) + a.pixels.size() * sizeof(PixelState);
}

} // namespace

Status write_checkpoint(const std::string& path, std::uint64_t key, const Accumulator& a, Links links)
{
    std::vector<std::uint8_t> bytes(sizeof(Header) + body_size(a));
    std::uint8_t* body = bytes.data() + sizeof(Header);
    const std::size_t passes = a.passes.size() * sizeof(std::uint32_t);
    std::memcpy(body, a.passes.data(), passes);
    std::memcpy(body + passes, a.pixels.data(), a.pixels.size() * sizeof(PixelState));
    Header h = {};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.key = key, h.width = a.width, h.height = a.height;
    h.content_hash = hash_bytes(body, body_size(a));
    std::memcpy(bytes.data(), &h, sizeof h);
    return write_file_atomic(path, bytes.data(), bytes.size(), links);
}

Status parse_checkpoint(const std::uint8_t* data, std::size_t size, const std::string& path, std::uint64_t key, Accumulator& into)
{
    const auto refuse = [&](const char* reason) { return Error{ExitCode::bad_input, path, "", reason}; };
    Header h;
    if (size < sizeof h || std::memcmp(data, kMagic, sizeof kMagic) != 0)
        return refuse("is not a checkpoint of a reference picture");
    std::memcpy(&h, data, sizeof h);
    if (h.width != into.width || h.height != into.height || h.key != key)
        return refuse("is a checkpoint of another picture: scene, environment, view or options differ");
    const std::uint8_t* body = data + sizeof h;
    if (size != sizeof h + body_size(into) || hash_bytes(body, body_size(into)) != h.content_hash)
        return refuse("is a damaged checkpoint");
    const std::size_t passes = into.passes.size() * sizeof(std::uint32_t);
    std::memcpy(into.passes.data(), body, passes);
    std::memcpy(into.pixels.data(), body + passes, into.pixels.size() * sizeof(PixelState));
    return {};
}

namespace {

constexpr char kBlocksMagic[8] = {'B', 'N', 'B', 'L', 'K', '0', '1', '\n'};

struct BlocksHeader { // then each block's passes as 32 bits, then the states of its pixels, row by row
    char magic[8];
    std::uint64_t key;
    std::int32_t width, height;
    std::uint32_t first, count;
};

// Calls `use` for each row of a block's pixels: index of the first pixel, number of pixels.
template <class Use> void each_row(const Accumulator& a, std::size_t index, const Use& use)
{
    const PixelBlock block = block_of(a, index, 0);
    for (int y = 0; y < block.height; ++y)
        use(static_cast<std::size_t>(block.y0 + y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(block.x0),
            static_cast<std::size_t>(block.width));
}

} // namespace

std::vector<std::uint8_t> blocks_of(const Accumulator& a, std::uint64_t key, std::uint32_t first, std::uint32_t count)
{
    BN_CHECK(std::uint64_t{first} + count <= a.passes.size());
    std::vector<std::uint8_t> bytes;
    const auto put = [&](const void* data, std::size_t size) {
        const std::size_t at = bytes.size();
        bytes.resize(at + size);
        std::memcpy(bytes.data() + at, data, size);
    };
    BlocksHeader h = {};
    std::memcpy(h.magic, kBlocksMagic, sizeof h.magic);
    h.key = key, h.width = a.width, h.height = a.height, h.first = first, h.count = count;
    put(&h, sizeof h);
    for (std::size_t i = first; i < std::size_t{first} + count; ++i) {
        put(&a.passes[i], sizeof a.passes[i]);
        each_row(a, i, [&](std::size_t pixel, std::size_t width) { put(&a.pixels[pixel], width * sizeof(PixelState)); });
    }
    return bytes;
}

Status take_blocks(const std::vector<std::uint8_t>& bytes, std::uint64_t key, Accumulator& into)
{
    const auto refuse = [](const char* reason) { return Error{ExitCode::bad_input, "", "", reason}; };
    BlocksHeader h;
    if (bytes.size() < sizeof h || std::memcmp(bytes.data(), kBlocksMagic, sizeof h.magic) != 0)
        return refuse("is no part of a reference picture");
    std::memcpy(&h, bytes.data(), sizeof h);
    if (h.width != into.width || h.height != into.height || h.key != key || std::uint64_t{h.first} + h.count > into.passes.size())
        return refuse("is part of another picture: scene, environment, view or options differ");
    std::size_t size = sizeof h;
    for (std::size_t i = h.first; i < std::size_t{h.first} + h.count; ++i) {
        size += sizeof(std::uint32_t);
        each_row(into, i, [&](std::size_t, std::size_t width) { size += width * sizeof(PixelState); });
    }
    if (bytes.size() != size)
        return refuse("is a damaged part of a picture");
    const std::uint8_t* from = bytes.data() + sizeof h;
    const auto get = [&](void* data, std::size_t count) {
        std::memcpy(data, from, count);
        from += count;
    };
    for (std::size_t i = h.first; i < std::size_t{h.first} + h.count; ++i) {
        get(&into.passes[i], sizeof into.passes[i]);
        each_row(into, i, [&](std::size_t pixel, std::size_t width) { get(&into.pixels[pixel], width * sizeof(PixelState)); });
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
