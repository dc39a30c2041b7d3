// Build tool with arguments MODULE HEADER: writes the module's hash as a constant.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "core/image/io/module_hash.h"

int main(int argc, char** argv)
{
    if (argc != 3)
        return 2;
    std::ifstream in(argv[1], std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const std::optional<std::uint64_t> hash = burnish::module_hash(bytes);
    if (!hash) {
        std::fprintf(stderr, "%s: no module\n", argv[1]);
        return 1;
    }
    std::ofstream(argv[2]) << "#pragma once\ninline constexpr unsigned long long kModuleHash = " << *hash << "ull;\n";
    return 0;
}
