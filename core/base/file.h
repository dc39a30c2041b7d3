// Whole files: reading with a size limit, writing atomically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// The bytes of a regular file of 1 to `max_bytes` bytes; anything else (missing, folder, pipe, empty, larger)
// is an Error with ExitCode::bad_input.
Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes);

// Writes a temporary file in the folder of `path` and renames it, so the name only ever shows a complete
// file; a symbolic link keeps pointing to its target, and a device or pipe is written directly. On failure
// nothing is left and the Error has ExitCode::output_failed.
Status write_file_atomic(const std::string& path, const void* data, std::size_t size);

} // namespace burnish
