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
    std::string name;                               // of the program in reasons; empty: the first word
    std::string hidden{};                           // taken out of the output: runs in other folders leave the same texts
    std::string folder;                             // to run in
    std::map<std::string, std::string> environment; // variables besides this process' variables
    std::string output;                             // file for the program's output: at most its first and last 512 KiB
    double seconds = 300.0;                         // limit; then the program and its children are killed
    const std::atomic<bool>* stop = nullptr;        // kills them too
};

// Returns success if the program ends with 0. Else the Error's reason says how it ended. Its code is not_finite or output_failed for that
// exit code. Its code is unavailable for a program that did not start, was killed from outside or took too long: another machine may
// succeed. Thread-safe.
Status run_child(const ChildRun& run);

} // namespace burnish
