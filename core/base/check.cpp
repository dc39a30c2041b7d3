#include "core/base/check.h"

#include <fmt/format.h>

namespace burnish {

void check_failed(const char* file, int line, const char* text, long long a, long long b)
{
    throw CheckFailed(fmt::format("check failed at {}:{}: {} ({}, {})", file, line, text, a, b));
}

} // namespace burnish
