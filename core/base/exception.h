// Errors out of exceptions that libraries throw. burnish's own code returns errors.
#pragma once
#include <exception>

#include "core/base/result.h"

namespace burnish {

// Unwinds work that its caller stops (core/jobs/control.h).
struct Stopped : std::exception {
    const char* what() const noexcept override { return "stopped"; }
};

// Returns the error of the exception that a catch block handles. Too little memory and a refused thread are ExitCode::bad_input with a
// reason of their own. Work that its caller stops is ExitCode::stopped. Any other exception keeps `error`, and its first line follows
// error.reason.
Error error_of_exception(Error error);

} // namespace burnish
