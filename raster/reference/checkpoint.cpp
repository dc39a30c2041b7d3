#include "raster/reference/checkpoint.h"

#include <cstring>
#include <filesystem>
#include <vector>

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
