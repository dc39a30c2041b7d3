// Disk cache: baked environments, Vulkan pipelines, chart references, mip levels made by nets and optimisers, and the
// sky's visibility of staged scenes. Any file may vanish at any time; burnish then makes the file again. The folder has
// a size limit, and the least recently used files go first.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/descriptor.h"

namespace burnish {

// Returns $XDG_CACHE_HOME/burnish or ~/.cache/burnish. Returns "" where neither is an absolute path.
std::string cache_folder();

inline constexpr std::uint64_t kDefaultCacheBytes = 2ull << 30; // room for some hundred environments, or twenty references of 1920x1080
// Returns the size limit in bytes: $BURNISH_CACHE_BYTES, such as 500M or 4G. Returns the default where the variable
// holds no such number.
std::uint64_t cache_limit();

struct CacheUse {
    std::uint64_t files = 0, bytes = 0;
};
// Counts the cache files in `folder` and their bytes. Other files do not count, and pruning never removes them.
CacheUse cache_use(const std::string& folder);

// Records a read of `file`: the file becomes the youngest.
void note_cache_use(const std::string& file);
// Removes the least recently used files until at most `limit` bytes are left. Never removes `keep`.
void prune_cache(const std::string& folder, std::uint64_t limit, const std::string& keep);

// The right to make a cache file, so that processes that want the same file make it once. The constructor waits while
// another holder makes `file`, at most `most_seconds`. Nobody waits where the folder cannot be
// written, or on a file system without locks.
class CacheLock {
  public:
    // while_waiting: called fifty times a second meanwhile; it may throw to end the wait.
    CacheLock(const std::string& file, double most_seconds, void (*while_waiting)() = nullptr);
    bool waited() const { return waited_; } // the file may have appeared meanwhile
    bool held() const { return static_cast<bool>(lock_); }

  private:
    Descriptor lock_;
    bool waited_ = false;
};
inline constexpr double kMostLockSeconds = 600.0; // a stopped holder keeps its lock; beyond this, work is done twice

} // namespace burnish
