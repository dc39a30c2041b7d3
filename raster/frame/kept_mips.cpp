#include "raster/frame/kept_mips.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>

#include "core/base/cache.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/pyramid_file.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
namespace {

constexpr std::uint32_t kKeptVersion = 3; // of what makes levels: raised where the same maps give others
constexpr std::uint64_t kMostKeptBytes = 4ull << 30;

std::string kept_path(const std::string& folder, std::uint64_t source, const Scene& scene, const Material& m)
{
    const struct {
        std::uint64_t source, net;
        std::uint32_t version, filter;
        float kappa;
        std::uint32_t gained;
    } of = {source,       levels_hash(*m.mip_net, m.mip_filter, is_metal(scene, m)),
            kKeptVersion, static_cast<std::uint32_t>(m.mip_filter),
            m.mip_kappa,  m.mip_gains ? gained_of(m.mip_net->shape.lobe, is_metal(scene, m)) : 0u};
    char name[64];
    std::snprintf(name, sizeof name, "/levels-%016" PRIx64 ".mip", hash_bytes(&of, sizeof of));
    return folder + name;
}

bool read_kept(const std::string& path, std::uint64_t source, const Scene& scene, const Material& m, std::vector<MipLevels>& to)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostKeptBytes, Links::refuse);
    if (!bytes)
        return false;
    Result<std::vector<MipLevels>> read = parse_mip_file(*bytes, path);
    if (!read || read->size() != 1 || !fits(read->front(), source, scene, m))
        return false;
    note_cache_use(path);
    to.push_back(std::move(read->front()));
    return true;
}

Status write_kept(const std::string& path, const MipLevels& levels)
{
    const std::string folder = std::filesystem::path(path).parent_path().string();
    std::error_code failed;
    std::filesystem::create_directories(folder, failed); // writing says what is wrong
    const std::vector<std::uint8_t> bytes = mip_file_bytes({&levels});
    const Status written = write_file_atomic(path, bytes.data(), bytes.size(), Links::refuse);
    prune_cache(folder, cache_limit(), path);
    return written;
}

} // namespace

void keep_mips(Scene& scene, const Jobs& jobs)
{
    const std::string folder = cache_folder();
    if (folder.empty())
        return;
    std::vector<MipLevels> kept;
    for (const Material& m : scene.materials) {
        if (!takes_net(m.mip_filter) || !m.mip_net || !is_filtered(scene, m))
            continue;
        const MipSource source = mip_source(scene, m);
        const std::uint64_t hash = source.hash(jobs);
        if (std::any_of(kept.begin(), kept.end(), [&](const MipLevels& levels) { return fits(levels, hash, scene, m); }))
            continue;
        const std::string path = kept_path(folder, hash, scene, m);
        if (read_kept(path, hash, scene, m, kept))
            continue;
        kept.push_back(make_mip_levels(source, m.mip_filter, m.mip_kappa, jobs, mip_help(scene, m)));
        if (const Status written = write_kept(path, kept.back()); !written)
            scene.warnings.push_back("levels of material '" + m.name + "' are not cached: " + written.error().line());
    }
    scene.kept_mips = std::make_shared<const std::vector<MipLevels>>(std::move(kept));
}

} // namespace burnish
