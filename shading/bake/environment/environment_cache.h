// Baked environments on disk, found by content hash. Anything unexpected in a cache file (truncation, another
// version, a wrong checksum) means that it is not there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shading/bake/environment/environment.h"

namespace burnish {

inline constexpr std::uint32_t kBakeVersion = 5; // raised whenever a bake gives other bits
inline constexpr int kIrradianceSize = 32;       // texels along an edge of the irradiance cube

std::uint64_t environment_hash(const Image& equirect, const EnvironmentOptions& options, int levels);

// Path of the cache file; empty where there is no folder to cache in.
std::string environment_cache_path(const EnvironmentOptions& options, std::uint64_t content_hash);

// What a cache file of that content, of a cube of `size` texels and `levels` levels, holds. Nothing unless every byte is as it was written
// and its figures, texels and key lights lie in their ranges.
std::optional<Environment> parse_environment_cache(const std::uint8_t* data, std::size_t bytes, std::uint64_t content_hash, int size,
                                                   int levels);
std::optional<Environment> read_environment_cache(const std::string& path, std::uint64_t content_hash, int size, int levels);
// The same bytes every time, of an environment that is neither turned nor exposed.
std::vector<std::uint8_t> environment_cache_bytes(const Environment& environment);
// Of such bytes in a file of any name, or in kBakedEnvironment of a folder: what `burnish bake environment` writes. Errors: bad_input.
inline constexpr const char* kBakedEnvironment = "environment.bnenv";
bool is_baked_environment(const std::string& path); // by its name, or as a folder
Result<Environment> read_baked_environment(const std::string& path);
// Creates the folder where needed. The file appears when it is complete; others go where the cache has become too large
// (core/base/cache.h).
Status write_environment_cache(const std::string& path, const Environment& environment);

} // namespace burnish
