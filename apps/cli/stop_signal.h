// Turns Ctrl-C and SIGTERM into a flag, for work that can resume later.
#pragma once
#include <atomic>

namespace burnish {

// From now on SIGINT and SIGTERM set the flag. A second signal ends the process as usual.
const std::atomic<bool>& watch_stop_signals();
void stop_at_signals(); // from now on both signals end the process, for work after all that can resume
int stop_signal();      // the signal received; 0: none

} // namespace burnish
