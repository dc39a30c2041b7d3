// Statistics of repeated runs, the process's memory, and the machine.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/clock.h"

namespace burnish {

struct Spread {
    double median = 0.0, low = 0.0, high = 0.0; // quartiles
};
Spread spread_of(std::vector<double> values); // expects at least one value

double load_average(); // over the last minute; -1 where unknown

// Returns the resident bytes now, and their peak since reset_peak_memory(). The reset returns false where the system
// lacks it.
std::uint64_t resident_bytes();
std::uint64_t peak_resident_bytes();
bool reset_peak_memory();

// The machine's availability to a thread: clock speed of a chain of additions, share of time spent waiting for a core,
// and load_average().
struct Quiet {
    double clock_ghz, waited, load;
    bool headline() const; // quiet enough for representative times
};
Quiet how_quiet();

// Returns processor, cores, version, compiler and load average.
nlohmann::ordered_json machine_json();

} // namespace burnish
