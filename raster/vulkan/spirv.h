// The words of SPIR-V, as far as pruning reads them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace burnish::spirv {

// Opcodes in the SPIR-V specification 1.6, section 3.49.
enum Op : std::uint32_t {
    kNop = 0,
    kName = 5,
    kLine = 8,
    kEntryPoint = 15,
    kTypeInt = 21,
    kTypeArray = 28,
    kTypeRuntimeArray = 29,
    kTypeStruct = 30,
    kTypePointer = 32,
    kConstantTrue = 41,
    kConstantFalse = 42,
    kConstant = 43,
    kSpecConstantTrue = 48,
    kSpecConstantFalse = 49,
    kSpecConstant = 50,
    kSpecConstantOp = 52,
    kFunction = 54,
    kFunctionParameter = 55,
    kFunctionEnd = 56,
    kFunctionCall = 57,
    kVariable = 59,
    kLoad = 61,
    kStore = 62,
    kCopyMemory = 63,
    kAccessChain = 65,
    kDecorate = 71,
    kMemberDecorate = 72,
    kImageWrite = 99,
    kIAdd = 128,
    kLogicalEqual = 164,
    kLogicalNotEqual = 165,
    kLogicalOr = 166,
    kLogicalAnd = 167,
    kLogicalNot = 168,
    kIEqual = 170,
    kINotEqual = 171,
    kSGreaterThan = 173,
    kSGreaterThanEqual = 175,
    kSLessThan = 177,
    kSLessThanEqual = 179,
    kShiftRightArithmetic = 195,
    kShiftLeftLogical = 196,
    kBitwiseOr = 197,
    kBitwiseAnd = 199,
    kEmitVertex = 218,
    kEndPrimitive = 219,
    kControlBarrier = 224,
    kMemoryBarrier = 225,
    kAtomicStore = 228,
    kPhi = 245,
    kLoopMerge = 246,
    kSelectionMerge = 247,
    kLabel = 248,
    kBranch = 249,
    kBranchConditional = 250,
    kSwitch = 251,
    kKill = 252,
    kReturn = 253,
    kReturnValue = 254,
    kUnreachable = 255,
    kNoLine = 317,
    kTerminateInvocation = 4416,
};
inline constexpr Op kWithoutResult[] = {kNop,
                                        kLine,
                                        kFunctionEnd,
                                        kStore,
                                        kCopyMemory,
                                        kImageWrite,
                                        kEmitVertex,
                                        kEndPrimitive,
                                        kAtomicStore,
                                        kLoopMerge,
                                        kBranch,
                                        kSelectionMerge,
                                        kSwitch,
                                        kControlBarrier,
                                        kMemoryBarrier,
                                        kKill,
                                        kReturn,
                                        kUnreachable,
                                        kReturnValue,
                                        kNoLine,
                                        kBranchConditional,
                                        kTerminateInvocation};
inline constexpr struct {
    Op op;
    std::uint32_t words;
} kLeast[] = {{kName, 2},
              {kEntryPoint, 3},
              {kDecorate, 2},
              {kFunction, 3},
              {kFunctionCall, 4},
              {kFunctionParameter, 3},
              {kLabel, 2},
              {kStore, 3},
              {kLoad, 4},
              {kBranch, 2},
              {kSwitch, 3},
              {kSelectionMerge, 2},
              {kPhi, 3},
              {kReturnValue, 2},
              {kLoopMerge, 3},
              {kBranchConditional, 4},
              {kAccessChain, 4},
              {kVariable, 4},
              {kTypeInt, 4},
              {kTypeArray, 4},
              {kTypeRuntimeArray, 3},
              {kTypeStruct, 2},
              {kTypePointer, 4},
              {kMemberDecorate, 4}};
inline constexpr std::uint32_t kMagic = 0x07230203, kFunctionStorage = 7;
inline constexpr std::uint32_t kSpecIdDecoration = 1, kStrideDecoration = 6, kBindingDecoration = 33, kSetDecoration = 34,
                               kOffsetDecoration = 35;
inline constexpr std::size_t kHeader = 5; // words

struct Instruction {
    const std::uint32_t* words;
    std::uint32_t count() const { return words[0] >> 16; }
    Op op() const { return static_cast<Op>(words[0] & 0xffff); }
    // Returns the id that the instruction defines in a function, or 0.
    std::uint32_t result() const
    {
        if (op() == kLabel)
            return words[1];
        return count() > 2 && std::find(std::begin(kWithoutResult), std::end(kWithoutResult), op()) == std::end(kWithoutResult) ? words[2]
                                                                                                                                : 0;
    }
};
using Values = std::map<std::uint32_t, std::int32_t>; // by id

inline std::optional<std::int32_t> value_in(const Values& values, std::uint32_t id)
{
    const auto known = values.find(id);
    return known == values.end() ? std::nullopt : std::optional(known->second);
}

} // namespace burnish::spirv
