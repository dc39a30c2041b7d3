// Loops on the process's own threads. Jobs chooses between these and oneTBB.
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

namespace burnish {

// Free worker numbers of one Jobs object, guarded by the pool's mutex. A thread keeps its number through inner loops.
using Seats = std::vector<int>;

// Starts threads until the pool has `wanted` of them or the system refuses one. Returns the number in the pool, at most
// `wanted`.
int start_pool(int wanted);

// Runs body(index, worker) for all indices below `count`, `grain` at a time, on the calling thread and the pool's
// threads. `threads` is the initial number of seats. Rethrows a body's first exception after all threads have left the
// loop.
void run_in_pool(Seats& seats, int threads, std::size_t count, std::size_t grain, const std::function<void(std::size_t, int)>& body);

} // namespace burnish
