// Several files in one piece, with figures beside them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct PackedFile {
    std::string name;
    std::vector<std::uint8_t> bytes;
};
struct Packed {
    std::string json; // figures
    std::vector<PackedFile> files;
};

std::vector<std::uint8_t> pack(const Packed& packed);
// Errors: ExitCode::bad_input. file: the name in the error.
Result<Packed> unpack(const std::vector<std::uint8_t>& bytes, const std::string& file);

// Reads a file that this process just wrote, and removes it.
Result<std::vector<std::uint8_t>> take_file(const std::string& path);

} // namespace burnish
