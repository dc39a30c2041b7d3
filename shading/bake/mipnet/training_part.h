// What is kept of a training, from which it goes on. Little-endian: 8 bytes "bnmipp1\n"; uint64 key of the options, steps done; float32
// numbers, their gradient's two moments and their moving average, each as plan_of() has them; uint64 xxHash64 of all before.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish::mipnet {

struct Trained { // everything that the work has so far
    std::uint64_t step = 0;
    std::vector<float> numbers, first, second, mean; // moments of the gradient; the moving average of the numbers
};

std::vector<std::uint8_t> training_part_bytes(std::uint64_t key, const Trained& t);

// Into `to`, whose vectors have their sizes. What is of another key, damaged, or further than `steps`, is an Error, and `to` is as it was.
Status parse_training_part(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps,
                           Trained& to);

} // namespace burnish::mipnet
