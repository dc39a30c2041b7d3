// Threads from a system that may refuse them (process limit, little address space). Work then goes on with fewer
// threads.
#pragma once
#include <string>

#include "core/base/result.h"

namespace burnish {

// Starts a thread that runs until the process ends. Returns 0, or the errno of a refusal.
int start_thread(void (*run)(void*), void* argument);

struct GivenThreads {
    int count, code; // threads given at once beside the running ones; errno of a refusal, or 0
};
// Tries to start `count` threads at once. All of them have ended on return.
GivenThreads given_threads(int count);

// Returns an Error with ExitCode::bad_input unless the system gives `count` threads at once beside the running ones.
// All of them have ended on return. Call before libraries that hang or end the process on a refused thread. `who`
// begins the sentence.
Status expect_threads(int count, const std::string& who);

// Records that `given` of `wanted` threads run, for the reason `code` (errno).
void note_missing_threads(int given, int wanted, int code);

// Returns one sentence on the greatest lack of threads so far; empty where the system gave all.
std::string missing_threads();

} // namespace burnish
