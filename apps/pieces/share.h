// Which part of a job's pieces a process does, as cluster engines and CI matrices tell it.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace burnish {

struct Share { // pieces whose number, divided by `count`, leaves `index`
    std::uint64_t index = 0, count = 1;
    bool holds(std::uint64_t piece) const { return piece % count == index; }
};

// Reads a variable of the environment; null: not set.
using ReadVariable = const char* (*)(const char* name);

// Parses a share:
//   I/N     I from 1 to N
//   auto    index and count as the environment of Slurm, OpenMPI, MPICH or Grid Engine says
//   auto/N  the index alone from the environment, as of Kubernetes
Result<Share> parse_share(const std::string& text, ReadVariable read);
Result<Share> parse_share(const std::string& text); // with this process' environment

} // namespace burnish
