// A file that was put into the program when it was built (embed.cmake).
#pragma once
#include <cstddef>

namespace burnish {

// Not before main(): the size is no constant expression.
struct EmbeddedFile {
    const char* bytes; // as in the file, at an address divisible by 16; a zero follows them
    std::size_t size;
};

} // namespace burnish
