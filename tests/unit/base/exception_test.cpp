// Errors out of exceptions: a lack of memory or threads has one code, wherever a library throws.
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

#include "core/base/exception.h"

namespace burnish {
namespace {

template <class Thrown> Error error_of(const Thrown& thrown)
{
    try {
        throw thrown;
    } catch (...) {
        return error_of_exception(Error{ExitCode::output_failed, "o.exr", "", "the image cannot be encoded"});
    }
}

TEST(exception, lack_of_memory_or_threads_is_bad_input)
{
    const Error memory = error_of(std::bad_alloc()),
                threads = error_of(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again)));
    EXPECT_EQ(memory.code, ExitCode::bad_input);
    EXPECT_EQ(memory.reason, "out of memory");
    EXPECT_EQ(memory.file, "o.exr");
    EXPECT_EQ(threads.code, ExitCode::bad_input);
    EXPECT_EQ(threads.reason.rfind("the system gives no further thread: ", 0), 0u) << threads.reason;
}

TEST(exception, others_keep_the_error_and_add_their_first_line)
{
    const Error other = error_of(std::runtime_error("broken header.\nsecond line"));
    EXPECT_EQ(other.code, ExitCode::output_failed);
    EXPECT_EQ(other.reason, "the image cannot be encoded: broken header");
    EXPECT_EQ(error_of(std::system_error(std::make_error_code(std::errc::permission_denied))).code, ExitCode::output_failed);
    EXPECT_EQ(error_of(7).reason, "the image cannot be encoded: unknown exception");
}

} // namespace
} // namespace burnish
