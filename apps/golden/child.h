// Runs another program with a time limit.
#pragma once
#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct ChildRun {
    std::vector<std::string> words;                 // program and arguments; a name without '/' is looked up in PATH
    std::string folder;                             // to run in
    std::map<std::string, std::string> environment; // variables besides those of this process
    std::string output;                             // file for the program's output: at most its first and last 512 KiB
    double seconds = 300.0;                         // limit; then the program and its children are killed
    const std::atomic<bool>* stop = nullptr;        // kills them too
};

// Returns success if the program ends with 0. Else the Error's reason says how it ended; its code is not_finite for that exit code.
// Thread-safe.
Status run_child(const ChildRun& run);

} // namespace burnish
