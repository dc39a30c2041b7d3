// Errors in place of exceptions, at the library's border.
#pragma once
#include <string>

#include "core/base/exception.h"

namespace burnish {

// Returns the result of `body`. Turns an exception into an Error.
template <class Body> auto guarded(const std::string& what, const Body& body) -> decltype(body())
{
    try {
        return body();
    } catch (...) {
        return error_of_exception(Error{ExitCode::internal, what, "", "internal error"});
    }
}

} // namespace burnish
