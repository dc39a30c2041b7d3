// Loops on threads of the process's own: see Jobs, which chooses.
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

namespace burnish {

// Worker numbers of one Jobs object that no thread has, guarded by the pool's mutex. A thread keeps its number through inner loops.
using Seats = std::vector<int>;

// Starts threads until there are so many, or the system refuses one. Returns how many there are, at most `wanted`.
int start_pool(int wanted);

// Runs body(index, worker) for all indices below `count`, `grain` at a time, on the calling thread and on those of the pool. threads: as
// many as there were seats. An exception of a body is thrown once all have left.
void run_in_pool(Seats& seats, int threads, std::size_t count, std::size_t grain, const std::function<void(std::size_t, int)>& body);

} // namespace burnish
