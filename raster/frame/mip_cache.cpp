#include "raster/frame/mip_cache.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/base/cache.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/jobs/activity.h"
#include "core/jobs/control.h"
#include "raster/frame/colours.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
namespace {

constexpr std::uint32_t kCacheVersion = 4; // version of the makers: raise it when the same maps give other levels
constexpr std::uint64_t kMostCacheBytes = 4ull << 30;

std::string cache_path(const std::string& folder, const void* of, std::size_t size)
{
    char name[64];
    std::snprintf(name, sizeof name, "/levels-%016" PRIx64 ".mip", hash_bytes(of, size));
    return folder + name;
}

std::string cache_path(const std::string& folder, std::uint64_t source, const Scene& scene, const Material& m, const MaterialMips& mips)
{
    const struct {
        std::uint64_t source, net;
        std::uint32_t version, filter;
        float kappa;
        std::uint32_t gained;
    } of = {source,        levels_hash(*mips.net, mips.filter, is_metal(scene, m)),
            kCacheVersion, static_cast<std::uint32_t>(mips.filter),
            mips.kappa,    mips.gains ? gained_of(mips.net->shape.lobe, is_metal(scene, m)) : 0u};
    return cache_path(folder, &of, sizeof of);
}

std::string cache_path(const std::string& folder, const MapId& id)
{
    const struct {
        MapId id;
        std::uint64_t version;
    } of = {id, kCacheVersion};
    return cache_path(folder, &of, sizeof of);
}

MipFile read_cached(const std::string& path)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostCacheBytes, Links::refuse);
    if (!bytes)
        return {};
    Result<MipFile> read = parse_mip_file(*bytes, path);
    return read ? std::move(*read) : MipFile();
}

// Waits while another process makes the levels, then calls find() again. Returns true if it finds them.
template <class Find> bool found_after_waiting(std::optional<CacheLock>& lock, const std::string& path, const Find& find)
{
    const Activity activity("waiting for another process that makes these levels");
    lock.emplace(path, kMostLockSeconds, check_stop);
    return find(); // another may have ended just now
}

Status write_cached(const std::string& path, const MipParts& levels)
{
    const std::string folder = std::filesystem::path(path).parent_path().string();
    std::error_code failed;
    std::filesystem::create_directories(folder, failed); // write_mip_file() reports errors
    const Status written = write_mip_file(path, levels, Links::refuse);
    prune_cache(folder, cache_limit(), path);
    return written;
}

void cache_lobes(Scene& scene, const Material& m, MaterialMips& mips, const std::string& folder, const Jobs& jobs,
                 std::vector<MipLevels>& cached)
{
    const MipSource source = mip_source(scene, m);
    const std::uint64_t hash = source_hash(source, mips, jobs);
    const auto fit = [&](const MipLevels& levels) { return fits(levels, source, hash, scene, m, mips); };
    if (std::any_of(cached.begin(), cached.end(), fit))
        return;
    const std::string path = cache_path(folder, hash, scene, m, mips);
    const auto find = [&] {
        MipFile file = read_cached(path);
        if (file.materials.size() != 1 || !file.maps.empty() || !fit(file.materials[0]))
            return false;
        note_cache_use(path);
        cached.push_back(std::move(file.materials[0]));
        return true;
    };
    std::optional<CacheLock> lock; // until the levels are cached
    if (find() || found_after_waiting(lock, path, find))
        return;
    const Activity activity("levels of " + levels_name(scene, m, mips));
    cached.push_back(make_mip_levels(source, mips.filter, mips.kappa, jobs, mip_help(scene, m, mips)));
    if (const Status written = write_cached(path, {{&cached.back()}, 0, {}}); !written)
        scene.warnings.push_back("levels of " + material_text(scene, m) + " are not cached: " + written.error().line());
}

void cache_map(Scene& scene, const Material& m, const UsedMap& map, const std::string& folder, const Jobs& jobs,
               std::vector<MapLevels>& cached)
{
    const MapId id = map_id(scene, m, map, jobs);
    const Image& image = map_image(scene, *map.ref);
    if (find_map(cached, id, image))
        return;
    const std::string path = cache_path(folder, id);
    const auto find = [&] {
        MipFile file = read_cached(path);
        if (!file.materials.empty() || file.maps.size() != 1 || !find_map(file.maps, id, image))
            return false;
        note_cache_use(path);
        cached.push_back(std::move(file.maps[0]));
        return true;
    };
    std::optional<CacheLock> lock; // until the levels are cached
    if (find() || found_after_waiting(lock, path, find))
        return;
    const Activity activity(std::string("levels of the ") + name_of(map.part) + " of " + material_text(scene, m));
    cached.push_back(map_levels(scene, m, map, id, jobs));
    if (const Status written = write_cached(path, {{}, 1, [&](std::size_t) { return cached.back(); }}); !written)
        scene.warnings.push_back(std::string("levels of the ") + name_of(map.part) + " of " + material_text(scene, m) +
                                 " are not cached: " + written.error().line());
}

} // namespace

void cache_mips(Scene& scene, SceneMips& mips, const Jobs& jobs)
{
    const std::string folder = cache_folder();
    if (folder.empty())
        return;
    MipFile cached;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        const MaterialMips& of = mips.of(i);
        if (takes_net(of.filter) && of.net && is_filtered(scene, m, of))
            cache_lobes(scene, m, mips.materials[i], folder, jobs, cached.materials);
        for (const UsedMap& map : used_maps(scene, m, of))
            if (map.coupled || map.kernel != ColourKernel::box)
                cache_map(scene, m, map, folder, jobs, cached.maps);
    }
    if (!cached.materials.empty() || !cached.maps.empty())
        mips.cached = std::make_shared<const MipFile>(std::move(cached));
}

} // namespace burnish
