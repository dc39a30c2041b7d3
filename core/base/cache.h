// What burnish keeps on disk to save time: baked environments, pipelines of Vulkan devices, references of charts, levels of maps by nets
// and by searches. Any of it may go at any time and is made again. Its folder has a limit; what was not used for the longest time goes
// first.
#pragma once
#include <cstdint>
#include <string>

namespace burnish {

// $XDG_CACHE_HOME/burnish or ~/.cache/burnish; empty where neither is an absolute path.
std::string cache_folder();

inline constexpr std::uint64_t kUsualCacheBytes = 2ull << 30; // some hundred environments, or twenty references of 1920x1080
// BURNISH_CACHE_BYTES of the environment, such as 500M or 4G; where that is no such number, the usual limit.
std::uint64_t cache_limit();

struct CacheUse {
    std::uint64_t files = 0, bytes = 0;
};
CacheUse cache_use(const std::string& folder); // files that have the name of something kept: others do not count and are never removed

void note_cache_use(const std::string& file); // it was read: it is the youngest now
// Removes what was not used for the longest time until no more than `limit` bytes are left. `keep` is never removed.
void prune_cache(const std::string& folder, std::uint64_t limit, const std::string& keep);

} // namespace burnish
