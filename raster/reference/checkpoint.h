// Reads and writes the state of an unfinished picture.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/result.h"
#include "raster/reference/accumulator.h"

namespace burnish {

// Writes a checkpoint. key: hash of everything that a sample depends on. The file appears only when complete.
Status write_checkpoint(const std::string& path, std::uint64_t key, const Accumulator& a, Links links = Links::follow);

// Parses a checkpoint into an accumulator with equal size. Leaves the accumulator unchanged if the key differs or the bytes are damaged.
// path: name for errors.
Status parse_checkpoint(const std::uint8_t* data, std::size_t size, const std::string& path, std::uint64_t key, Accumulator& into);

// Returns the state of `count` blocks from `first` on, which have equal passes.
std::vector<std::uint8_t> blocks_of(const Accumulator& a, std::uint64_t key, std::uint32_t first, std::uint32_t count);
// Adds such a state, whose passes follow the accumulator's passes. Leaves the accumulator unchanged if key, size or passes differ.
Status take_blocks(const std::vector<std::uint8_t>& bytes, std::uint64_t key, Accumulator& into);

// Reads a checkpoint into an accumulator with equal size. A missing file is not an error. Returns true if a checkpoint was read.
Result<bool> read_checkpoint(const std::string& path, std::uint64_t key, Accumulator& into, Links links = Links::follow);

} // namespace burnish
