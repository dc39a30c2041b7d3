#include "core/base/exception.h"

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "core/base/text.h"

namespace burnish {

Error error_of_exception(Error error)
{
    std::string reason;
    try {
        throw;
    } catch (const std::bad_alloc&) {
        error.code = ExitCode::bad_input, error.reason = "out of memory";
        return error;
#ifdef __EMSCRIPTEN__
    } catch (const std::length_error&) { // a size beyond 32 bits
        error.code = ExitCode::bad_input, error.reason = "out of memory";
        return error;
#endif
    } catch (const Stopped&) {
        return Error{ExitCode::stopped, error.file, "", "stopped"};
    } catch (const std::system_error& thrown) {
        reason = printable(first_line(thrown.what()));
        if (thrown.code() == std::errc::resource_unavailable_try_again) {
            error.code = ExitCode::bad_input, error.reason = "the system gives no further thread: " + reason;
            return error;
        }
    } catch (const std::exception& thrown) {
        reason = printable(first_line(thrown.what()));
    } catch (...) {
        reason = "unknown exception";
    }
    if (!reason.empty())
        error.reason += ": " + reason;
    return error;
}

} // namespace burnish
