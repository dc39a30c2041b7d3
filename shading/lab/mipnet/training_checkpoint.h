// Checkpoint of a training. Little-endian: 8 bytes "bnmipp1\n"; uint64 key of the options, finished steps; float32 numbers, their
// gradient's two moments and their moving average, each as in plan_of(); uint64 xxHash64 of all bytes before.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish::mipnet {

struct Trained { // all progress of a training
    std::uint64_t step = 0;
    std::vector<float> numbers, first, second, mean; // moments of the gradient; moving average of the numbers
};

std::vector<std::uint8_t> training_checkpoint_bytes(std::uint64_t key, const Trained& t);

// Parses a checkpoint into `to`, whose vectors must have their sizes. Another key, damage, or more than `steps` steps is an Error, and
// `to` stays unchanged.
Status parse_training_checkpoint(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps,
                                 Trained& to);

} // namespace burnish::mipnet
