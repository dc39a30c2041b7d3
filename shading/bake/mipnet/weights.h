// A cascade in memory and as a file.
//
// The file, little-endian: 8 bytes "bnmip01\n"; uint32 version (1), lobe, layout (+ 2: H_B sees 8 x 8 texels), channels (5), number and
// width of H_A's hidden layers, of H_B's (0, 0: none), numbers, bytes of text; uint64 seed, steps, hash of the training set; float32 leak;
// uint32 0; the text (families, a line break, the command that makes the file); the numbers as IEEE halves (rounded to nearest even), layer
// by layer of H_A, then H_B, weights by [output][input], then biases, at last k0 and k1 of kappa; uint64 xxHash64 of all bytes before.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/mipnet/net.h"

namespace burnish::mipnet {

inline constexpr std::uint32_t kWeightsVersion = 1;

struct Weights {
    Shape shape;
    std::uint64_t seed = 0, steps = 0, data = 0; // data: hash of the training set
    std::string families, command;
    std::vector<float> numbers; // as in plan_of(shape), each a half
};

std::uint64_t net_hash(const Weights& weights); // of the shape and the numbers

std::vector<std::uint8_t> weights_bytes(const Weights& weights);
// Parse and check a file. Errors: bad_input.
Result<Weights> parse_weights(const std::uint8_t* data, std::size_t bytes, const std::string& path);
Result<Weights> read_weights(const std::string& path);
Status write_weights(const std::string& path, const Weights& weights);

} // namespace burnish::mipnet
