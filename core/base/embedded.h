// A file built into the program (embed.cmake).
#pragma once
#include <cstddef>

namespace burnish {

// Not usable before main(): the size is no constant expression.
struct EmbeddedFile {
    const char* bytes; // the file's bytes, 16-byte aligned and followed by a zero
    std::size_t size;
};

} // namespace burnish
