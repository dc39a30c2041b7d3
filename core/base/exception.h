// Errors out of exceptions that libraries throw. burnish's own code returns errors.
#pragma once
#include "core/base/result.h"

namespace burnish {

// Returns the error of the exception that a catch block handles. Too little memory and a refused thread are ExitCode::bad_input with a
// reason of their own. Any other exception keeps `error`, and its first line follows error.reason.
Error error_of_exception(Error error);

} // namespace burnish
