#include "raster/session/visibility_cache.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/base/cache.h"
#include "core/base/file.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

struct Header { // the visibilities follow
    char magic[8];
    std::uint64_t hash, count, payload_hash;
    std::uint64_t header_hash; // of all fields above
};
static_assert(sizeof(Header) == 40);
constexpr char kMagic[8] = {'b', 'u', 'r', 'n', 's', 'k', 'y', '\n'};

std::uint64_t hash_of(const Header& h)
{
    return hash_bytes(&h, offsetof(Header, header_hash));
}

} // namespace

std::string visibility_path(std::uint64_t hash)
{
    const std::string folder = cache_folder();
    char name[64];
    std::snprintf(name, sizeof name, "/sky-%016" PRIx64 ".vis", hash);
    return folder.empty() ? "" : folder + name;
}

std::optional<std::vector<float>> read_visibility_cache(const std::string& path, std::uint64_t hash, std::size_t count)
{
    const std::size_t size = sizeof(Header) + count * sizeof(float);
    const Result<std::vector<std::uint8_t>> file = read_file(path, size, Links::refuse);
    if (!file || file->size() != size)
        return std::nullopt;
    Header h;
    std::memcpy(&h, file->data(), sizeof h);
    const std::uint8_t* payload = file->data() + sizeof h;
    if (std::memcmp(h.magic, kMagic, sizeof kMagic) != 0 || h.hash != hash || h.count != count || h.header_hash != hash_of(h) ||
        h.payload_hash != hash_bytes(payload, count * sizeof(float)))
        return std::nullopt;
    std::vector<float> found(count);
    std::memcpy(found.data(), payload, count * sizeof(float));
    if (!std::all_of(found.begin(), found.end(), [](float v) { return v >= 0.0f && v <= 1.0f; }))
        return std::nullopt;
    note_cache_use(path);
    return found;
}

Status write_visibility_cache(const std::string& path, std::uint64_t hash, const std::vector<float>& visibility)
{
    const std::size_t bytes = visibility.size() * sizeof(float);
    Header h = {};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.hash = hash, h.count = visibility.size(), h.payload_hash = hash_bytes(visibility.data(), bytes);
    h.header_hash = hash_of(h);
    std::vector<std::uint8_t> file(sizeof h + bytes);
    std::memcpy(file.data(), &h, sizeof h);
    std::memcpy(file.data() + sizeof h, visibility.data(), bytes);
    const std::string folder = std::filesystem::path(path).parent_path().string();
    std::error_code failed; // the write reports a folder that cannot be made
    std::filesystem::create_directories(folder, failed);
    const Status written = write_file_atomic(path, file.data(), file.size(), Links::refuse);
    prune_cache(folder, cache_limit(), path);
    return written;
}

} // namespace burnish
