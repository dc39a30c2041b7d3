// The HTTP server of `burnish serve`, on 127.0.0.1 alone.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "apps/serve/drawings.h"
#include "core/base/result.h"

namespace burnish {

struct ServeSetting {
    std::string target;        // file, folder or builtin:NAME
    std::string output_folder; // where pages may save pictures; empty: nowhere
    int port = 0;              // 0: any that is free
    bool watch = false;        // draw again where a file changes
    Limits limits;
    std::vector<std::string> limit_words; // options of the limits that were given, for the commands that pages show
    int threads = 0;
};

// Serves until `stop`. Calls `ready` with the page's address, which holds a random token; requests without the token, or for another host
// name, are refused. Errors: ExitCode::usage for a port that is taken, bad_input for the target.
Status serve(const ServeSetting& setting, const std::atomic<bool>& stop, const std::function<void(const std::string&)>& ready);

} // namespace burnish
