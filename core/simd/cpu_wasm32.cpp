#include "core/simd/cpu.h"

namespace burnish {

std::string cpu_name()
{
    return "WebAssembly";
}

} // namespace burnish
