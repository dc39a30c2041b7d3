// The state of a picture in the making as a file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/file.h"
#include "core/base/result.h"
#include "raster/reference/accumulator.h"

namespace burnish {

// `key`: hash of everything that a sample depends on. The file appears under its name only when it is complete.
Status write_checkpoint(const std::string& path, std::uint64_t key, const Accumulator& a, Links links = Links::follow);

// What the bytes of a checkpoint hold, into an accumulator of the same size, which is left as it was where they are not those of `key`
// or not whole. `path` is their name in errors.
Status parse_checkpoint(const std::uint8_t* data, std::size_t size, const std::string& path, std::uint64_t key, Accumulator& into);

// Into an accumulator of the same size. A file that is not there is no error: true only if something was read.
Result<bool> read_checkpoint(const std::string& path, std::uint64_t key, Accumulator& into, Links links = Links::follow);

} // namespace burnish
