// The HTTP server of `burnish serve`, on 127.0.0.1 alone.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "apps/serve/pages.h"
#include "core/base/result.h"

namespace burnish {

// Serves until `stop`. Calls `ready` with the page's address, which holds a random token; requests without the token, or for another host
// name, are refused. Errors: ExitCode::usage for a port that is taken, bad_input for the target.
Status serve(const ServeSetting& setting, const std::atomic<bool>& stop, const std::function<void(const std::string&)>& ready);

} // namespace burnish
