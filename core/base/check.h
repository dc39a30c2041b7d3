// Contract checks. BN_CHECK is always on: where a caller breaks a function's condition, the function throws CheckFailed with both values.
// Functions of sessions turn that into an Error. BN_DCHECK vanishes in release builds.
#pragma once
#include <stdexcept>

namespace burnish {

struct CheckFailed : std::logic_error {
    using std::logic_error::logic_error;
};
[[noreturn]] void check_failed(const char* file, int line, const char* text, long long a, long long b);

} // namespace burnish

#define BN_CHECK(condition)                                                                                                                \
    do {                                                                                                                                   \
        if (!(condition))                                                                                                                  \
            ::burnish::check_failed(__FILE__, __LINE__, #condition, 0, 0);                                                                 \
    } while (0)
#define BN_CHECK_OP(a, op, b)                                                                                                              \
    do {                                                                                                                                   \
        if (!((a)op(b)))                                                                                                                   \
            ::burnish::check_failed(__FILE__, __LINE__, #a " " #op " " #b, static_cast<long long>(a), static_cast<long long>(b));          \
    } while (0)
#ifdef NDEBUG
#define BN_DCHECK(condition) static_cast<void>(0)
#else
#define BN_DCHECK(condition) BN_CHECK(condition)
#endif
