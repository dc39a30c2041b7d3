// Disk cache of the sky's visibility at places of a scene. A file with any fault counts as absent.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// Returns the path of the cache file for a hash of everything that decides the visibility. Empty if there is no cache folder.
std::string visibility_path(std::uint64_t hash);
// Returns `count` visibilities, [0,1], or nothing unless all checksums match.
std::optional<std::vector<float>> read_visibility_cache(const std::string& path, std::uint64_t hash, std::size_t count);
// Writes the file, and removes the oldest files of a full cache.
Status write_visibility_cache(const std::string& path, std::uint64_t hash, const std::vector<float>& visibility);

} // namespace burnish
