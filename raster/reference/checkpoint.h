// The state of a picture in the making as a file.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/file.h"
#include "core/base/result.h"
#include "raster/reference/accumulator.h"

namespace burnish {

// `key`: hash of everything that a sample depends on. The file appears under its name only when it is complete.
Status write_checkpoint(const std::string& path, std::uint64_t key, const Accumulator& a, Links links = Links::follow);

// Into an accumulator of the same size. A file that is not there is no error: true only if something was read.
Result<bool> read_checkpoint(const std::string& path, std::uint64_t key, Accumulator& into, Links links = Links::follow);

} // namespace burnish
