// Disk cache of baked environments, keyed by content hash. A cache file with any fault (truncation, another version, a wrong checksum)
// counts as absent.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shading/bake/environment/environment.h"

namespace burnish {

inline constexpr std::uint32_t kBakeVersion = 5; // raise it whenever a bake gives other bits
inline constexpr int kIrradianceSize = 32;       // texels along an edge of the irradiance cube

// Returns the hash of the image, the bake options and the bake version.
std::uint64_t environment_hash(const Image& equirect, const EnvironmentOptions& options, int levels);

// Returns the path of the cache file. Empty if there is no cache folder.
std::string environment_cache_path(const EnvironmentOptions& options, std::uint64_t content_hash);

// Parses a cache file with this content hash, for a cube of `size` texels and `levels` levels. Returns nothing unless all checksums match
// and all figures, texels and extracted lights lie in their ranges.
std::optional<Environment> parse_environment_cache(const std::uint8_t* data, std::size_t bytes, std::uint64_t content_hash, int size,
                                                   int levels);
std::optional<Environment> read_environment_cache(const std::string& path, std::uint64_t content_hash, int size, int levels);
// Serialises an environment without rotation and exposure. Equal environments give equal bytes.
std::vector<std::uint8_t> environment_cache_bytes(const Environment& environment);
// Reads such bytes from a file with any name, or from kBakedEnvironment in a folder: output of `burnish bake environment`. Errors:
// bad_input.
inline constexpr const char* kBakedEnvironment = "environment.bnenv";
bool is_baked_environment(const std::string& path); // by its extension, or as a folder
Result<Environment> read_baked_environment(const std::string& path);
// Writes a cache file. Creates the folder if needed. The file appears only when complete. Old files are removed if the cache is too large
// (core/base/cache.h).
Status write_environment_cache(const std::string& path, const Environment& environment);

} // namespace burnish
