// Figures of repeated runs, the process's clocks and memory, and the machine they were taken on.
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
Spread spread_of(std::vector<double> values); // of at least one

double load_average(); // of the last minute; -1 where it is not known

// Resident bytes now, and at most since reset_peak_memory(), which is false where the system cannot do it.
std::uint64_t resident_bytes();
std::uint64_t peak_resident_bytes();
bool reset_peak_memory();

// What a thread gets of the machine now: the clock that a chain of additions runs at, the share of the time that it waits for others to
// leave a core, and load_average().
struct Quiet {
    double clock_ghz, waited, load;
    bool headline() const; // quiet enough for times that stand for the program
};
Quiet how_quiet();

// processor, cores, version, compiler, load average.
nlohmann::ordered_json machine_json();

} // namespace burnish
