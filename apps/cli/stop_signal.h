// Ctrl-C and polite kills as a flag, for work that can be gone on with later.
#pragma once
#include <atomic>

namespace burnish {

// From now on SIGINT and SIGTERM set the flag; a second one ends the process as usual.
const std::atomic<bool>& watch_stop_signals();
int stop_signal(); // the signal that came, 0: none

} // namespace burnish
