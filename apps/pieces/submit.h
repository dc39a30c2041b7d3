// Scripts that run a job's pieces under a cluster's engine, then merge them.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct SubmitOptions {
    std::string engine;
    int shards = 8;
    int at_once = 0; // 0: all
    std::string work = "pieces";
    std::vector<std::string> words; // a subcommand and its options, without the options of pieces
};

std::vector<std::string> submit_engines();
// Refuses options that the engine does not take, and words that its script would read otherwise.
Status check_submit(const SubmitOptions& options);
std::string submit_script(const SubmitOptions& options);

} // namespace burnish
