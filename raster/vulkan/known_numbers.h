// Numbers in storage buffers that are known while a stage is used.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "raster/vulkan/prune.h"
#include "raster/vulkan/spirv.h"

namespace burnish::spirv {

// The storage buffers of set 0 and the known numbers in them.
class Buffers {
  public:
    Buffers(const std::vector<Instruction>& globals, const std::vector<KnownNumber>& numbers);

    // Returns the number that an access chain points at, if it is known. values: the values of the chain's constant indices.
    std::optional<std::int32_t> number_at(const Instruction& chain, const Values& values) const;

  private:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Pair, std::int32_t> numbers_;             // by binding and offset
    std::map<std::uint32_t, Instruction> types_;       // by id
    std::map<std::uint32_t, std::uint32_t> pointees_;  // types by type of pointer
    std::map<Pair, std::uint32_t> offsets_;            // by structure and member
    std::map<std::uint32_t, std::uint32_t> strides_;   // of arrays
    std::map<std::uint32_t, std::uint32_t> bindings_;  // by variable
    std::map<std::uint32_t, std::uint32_t> variables_; // types of pointers by variable
    std::set<std::uint32_t> elsewhere_;                // variables in other sets
};

} // namespace burnish::spirv
