#include "apps/cli/build.h"

#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/version.h"

namespace burnish {

std::uint64_t program_hash()
{
    constexpr std::uint64_t kMaxProgramBytes = 1ull << 30;
    static const std::uint64_t hash = [] {
        const Result<std::vector<std::uint8_t>> bytes = read_file("/proc/self/exe", kMaxProgramBytes);
        const std::string name = version();
        return bytes ? hash_bytes(bytes->data(), bytes->size()) : hash_bytes(name.data(), name.size());
    }();
    return hash;
}

} // namespace burnish
