// Threads as the system gives them: it may refuse (a limit on processes, little address space), and then work goes on with fewer.
#pragma once
#include <string>

#include "core/base/result.h"

namespace burnish {

// Starts a thread that runs until the process ends. Returns 0, or the errno of the refusal: then there is none.
int start_thread(void (*run)(void*), void* argument);

struct GivenThreads {
    int count, code; // threads that the system gave at once besides those that run; errno of its refusal, or 0
};
// Asks for up to `count` threads, which have ended when it returns.
GivenThreads given_threads(int count);

// Returns an Error with ExitCode::unavailable unless the system gives so many threads at once besides those that run; they have ended when
// it returns. Libraries that hang or end the process where a thread is refused are called only after this. who: begins the sentence.
Status expect_threads(int count, const std::string& who);

// Notes that `given` of `wanted` threads run, for the reason `code` (errno).
void note_missing_threads(int given, int wanted, int code);

// One sentence on the greatest lack of threads so far; empty where the system gave all.
std::string missing_threads();

} // namespace burnish
