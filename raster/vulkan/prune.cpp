#include "raster/vulkan/prune.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace burnish {
namespace {

// Opcodes in the SPIR-V specification 1.6, section 3.49.
enum Op : std::uint32_t {
    kNop = 0,
    kName = 5,
    kLine = 8,
    kEntryPoint = 15,
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
    kDecorate = 71,
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
constexpr Op kWithoutResult[] = {kNop,
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
constexpr struct {
    Op op;
    std::uint32_t words;
} kLeast[] = {{kName, 2},  {kEntryPoint, 3},  {kDecorate, 2},  {kFunction, 3},         {kFunctionCall, 4}, {kFunctionParameter, 3},
              {kLabel, 2}, {kStore, 3},       {kLoad, 4},      {kBranch, 2},           {kSwitch, 3},       {kSelectionMerge, 2},
              {kPhi, 3},   {kReturnValue, 2}, {kLoopMerge, 3}, {kBranchConditional, 4}};
constexpr std::uint32_t kMagic = 0x07230203, kSpecIdDecoration = 1, kFunctionStorage = 7;
constexpr std::size_t kHeader = 5; // words

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

// Folds the operators in conditions on constants.
std::optional<std::int32_t> folded(std::uint32_t op, std::int32_t a, std::int32_t b)
{
    const auto word = [](std::int32_t x) { return static_cast<std::uint32_t>(x); };
    switch (op) {
    case kIAdd:
        return static_cast<std::int32_t>(word(a) + word(b));
    case kLogicalEqual:
    case kIEqual:
        return a == b;
    case kLogicalNotEqual:
    case kINotEqual:
        return a != b;
    case kLogicalOr:
    case kBitwiseOr:
        return a | b;
    case kLogicalAnd:
    case kBitwiseAnd:
        return a & b;
    case kSGreaterThan:
        return a > b;
    case kSGreaterThanEqual:
        return a >= b;
    case kSLessThan:
        return a < b;
    case kSLessThanEqual:
        return a <= b;
    case kShiftRightArithmetic:
        return a >> (b & 31);
    case kShiftLeftLogical:
        return static_cast<std::int32_t>(word(a) << (b & 31));
    default:
        return std::nullopt;
    }
}

std::optional<std::int32_t> value_in(const Values& values, std::uint32_t id)
{
    const auto known = values.find(id);
    return known == values.end() ? std::nullopt : std::optional(known->second);
}

// Folds an operator with known operands. operands: ids of a, b; one id for `not`. `and` and `or` need only one known value if that
// decides.
std::optional<std::int32_t> folded(const Values& values, std::uint32_t op, const std::uint32_t* operands, std::size_t count)
{
    if (count < 1 || count > 2)
        return std::nullopt;
    const auto a = value_in(values, operands[0]), b = value_in(values, operands[count - 1]);
    if (op == kLogicalNot && count == 1 && a)
        return *a == 0;
    if (op == kLogicalAnd && ((a && *a == 0) || (b && *b == 0)))
        return 0;
    if (op == kLogicalOr && ((a && *a != 0) || (b && *b != 0)))
        return 1;
    return a && b && count == 2 ? folded(op, *a, *b) : std::nullopt;
}

// Known values at a point in a function.
struct Known {
    Values values; // by id
    Values stored; // by local variable

    void evaluate(const Instruction& i, const std::set<std::uint32_t>& variables)
    {
        if (i.op() == kStore && variables.count(i.words[1])) {
            stored.erase(i.words[1]);
            if (const auto value = value_in(values, i.words[2]))
                stored[i.words[1]] = *value;
        } else if (i.op() == kLoad && variables.count(i.words[3])) {
            if (const auto value = value_in(stored, i.words[3]))
                values[i.words[2]] = *value;
        } else if (i.count() == 4 || i.count() == 5) {
            if (const auto value = folded(values, i.op(), i.words + 3, i.count() - 3))
                values[i.words[2]] = *value;
        }
    }
};

using Functions = std::map<std::uint32_t, std::vector<Instruction>>; // by id

// Returns a one-block function's result for known arguments, such as a test for a constant's bit.
std::optional<std::int32_t> returned(const std::vector<Instruction>& body, const Values& constants,
                                     const std::vector<std::optional<std::int32_t>>& arguments)
{
    if (std::count_if(body.begin(), body.end(), [](const Instruction& i) { return i.op() == kLabel; }) != 1)
        return std::nullopt;
    Known known = {constants, {}};
    std::set<std::uint32_t> parameters;
    for (const Instruction& i : body) {
        if (i.op() == kFunctionParameter && parameters.size() < arguments.size()) {
            if (const auto& value = arguments[parameters.size()])
                known.stored[i.words[2]] = *value;
            parameters.insert(i.words[2]);
        } else if (i.op() == kReturnValue)
            return value_in(known.values, i.words[1]);
        else if (i.op() == kFunctionCall)
            for (std::uint32_t w = 4; w < i.count(); ++w)
                known.stored.erase(i.words[w]); // the callee may write it
        else
            known.evaluate(i, parameters);
    }
    return std::nullopt;
}

// Marks the reachable blocks of a function.
class Walk {
  public:
    Walk(const std::vector<Instruction>& body, const Functions& functions, const Values& constants)
        : body_(body), functions_(functions), constants_(constants), known_{constants, {}}
    {
        find_variables();
    }

    bool run() // false: not understood
    {
        std::size_t at = 0;
        while (at < body_.size() && body_[at].op() != kLabel)
            keep(body_[at++]);
        bool first = true;
        while (at < body_.size() && body_[at].op() == kLabel) {
            std::size_t end = at + 1;
            while (end < body_.size() && body_[end].op() != kLabel && body_[end].op() != kFunctionEnd)
                ++end;
            const std::uint32_t label = body_[at].words[1];
            if (first)
                entries_[label] = {};
            first = false;
            if (!(entries_.count(label) ? block(at, end) : dead_block(label)))
                return false;
            passed_.insert(label);
            at = end;
        }
        if (at >= body_.size())
            return at == body_.size() && first; // declarations have no blocks; other functions have an end
        keep(body_[at]);
        return at + 1 == body_.size();
    }

    std::vector<std::uint32_t> words;
    std::set<std::uint32_t> calls;
    std::vector<std::uint32_t> defined;

  private:
    struct Entry {
        std::vector<std::uint32_t> from; // predecessor blocks
        Values stored;                   // in local variables, where all predecessors agree
    };

    // Finds local variables that are only loaded, stored and passed to functions.
    void find_variables()
    {
        for (const Instruction& i : body_)
            if (i.op() == kVariable && i.count() >= 4 && i.words[3] == kFunctionStorage)
                variables_.insert(i.words[2]);
        for (const Instruction& i : body_)
            for (std::uint32_t w = 1; w < i.count(); ++w)
                if (!(i.op() == kVariable && w == 2) && !(i.op() == kLoad && w == 3) && !(i.op() == kStore && w == 1) &&
                    !(i.op() == kFunctionCall && w > 3))
                    variables_.erase(i.words[w]);
    }

    void keep(const Instruction& i)
    {
        words.insert(words.end(), i.words, i.words + i.count());
        if (const std::uint32_t id = i.result())
            defined.push_back(id);
        if (i.op() == kFunctionCall)
            calls.insert(i.words[3]);
    }

    // Notes an edge between blocks, and merges the stored values. Returns false if the edge is not understood.
    bool edge(std::uint32_t from, std::uint32_t to)
    {
        if (passed_.count(to) || to == from)
            return headers_.count(to) != 0;
        const auto known = entries_.find(to);
        if (known == entries_.end()) {
            entries_[to] = {{from}, known_.stored};
            return true;
        }
        Entry& e = known->second;
        e.from.push_back(from);
        for (auto it = e.stored.begin(); it != e.stored.end();) {
            const auto other = value_in(known_.stored, it->first);
            it = other && *other == it->second ? std::next(it) : e.stored.erase(it);
        }
        return true;
    }

    // Handles an unreachable block. It keeps its label if a remaining construct merges or continues there.
    bool dead_block(std::uint32_t label)
    {
        const auto loop = continues_.find(label);
        if (loop == continues_.end() && !merges_.count(label))
            return true;
        words.insert(words.end(), {2u << 16 | kLabel, label});
        defined.push_back(label);
        if (loop == continues_.end())
            words.push_back(1u << 16 | kUnreachable);
        else
            words.insert(words.end(), {2u << 16 | kBranch, loop->second});
        return true;
    }

    // Copies a reachable block, and replaces its branch if the condition is known.
    bool block(std::size_t begin, std::size_t end)
    {
        const std::uint32_t label = body_[begin].words[1];
        const Entry& entry = entries_[label];
        known_.stored = entry.stored;
        const Instruction last = body_[end - 1];
        const Instruction* merge =
            end - begin >= 3 && (body_[end - 2].op() == kLoopMerge || body_[end - 2].op() == kSelectionMerge) ? &body_[end - 2] : nullptr;
        const bool loop = merge && merge->op() == kLoopMerge;
        if (loop) {
            known_.stored.clear(); // values may differ in the next iteration
            headers_.insert(label), merges_.insert(merge->words[1]), continues_[merge->words[2]] = label;
        }
        keep(body_[begin]);
        for (std::size_t at = begin + 1; at + 1 < end; ++at) {
            const Instruction& i = body_[at];
            if (i.op() == kPhi) {
                if (loop)
                    return false;
                phi(i, entry.from);
            } else if (&i != merge) {
                i.op() == kFunctionCall ? call(i) : known_.evaluate(i, variables_);
                keep(i);
            }
        }
        if (last.op() == kBranchConditional && !loop) {
            if (const auto condition = value_in(known_.values, last.words[1])) {
                const std::uint32_t taken = last.words[*condition ? 2 : 3];
                words.insert(words.end(), {2u << 16 | kBranch, taken});
                return edge(label, taken);
            }
        }
        if (merge) {
            keep(*merge);
            merges_.insert(merge->words[1]);
        }
        keep(last);
        return leave(label, last);
    }

    bool leave(std::uint32_t label, const Instruction& last)
    {
        switch (last.op()) {
        case kBranch:
            return edge(label, last.words[1]);
        case kBranchConditional:
            return edge(label, last.words[2]) && edge(label, last.words[3]);
        case kSwitch: // 32-bit selectors
            for (std::uint32_t w = 2; w < last.count(); w += 2)
                if (!edge(label, last.words[w]))
                    return false;
            return true;
        case kReturn:
        case kReturnValue:
        case kKill:
        case kTerminateInvocation:
        case kUnreachable:
            return true;
        default:
            return false;
        }
    }

    void phi(const Instruction& i, const std::vector<std::uint32_t>& from)
    {
        const std::size_t begin = words.size();
        words.insert(words.end(), i.words, i.words + 3);
        std::optional<std::int32_t> value;
        bool same = true;
        for (std::uint32_t w = 3; w + 1 < i.count(); w += 2) {
            if (std::find(from.begin(), from.end(), i.words[w + 1]) == from.end())
                continue;
            const auto coming = value_in(known_.values, i.words[w]);
            same = same && coming && (!value || *value == *coming);
            value = coming;
            words.insert(words.end(), {i.words[w], i.words[w + 1]});
        }
        words[begin] = static_cast<std::uint32_t>(words.size() - begin) << 16 | kPhi;
        defined.push_back(i.words[2]);
        if (same && value)
            known_.values[i.words[2]] = *value;
    }

    void call(const Instruction& i)
    {
        std::vector<std::optional<std::int32_t>> arguments;
        for (std::uint32_t w = 4; w < i.count(); ++w) {
            arguments.push_back(value_in(known_.stored, i.words[w]));
            known_.stored.erase(i.words[w]); // the callee may write it
        }
        const auto function = functions_.find(i.words[3]);
        if (function == functions_.end())
            return;
        if (const auto value = returned(function->second, constants_, arguments))
            known_.values[i.words[2]] = *value;
    }

    const std::vector<Instruction>& body_;
    const Functions& functions_;
    const Values& constants_;
    Known known_;                                                   // in the current block
    std::set<std::uint32_t> variables_, passed_, headers_, merges_; // ids; blocks
    std::map<std::uint32_t, std::uint32_t> continues_;              // maps continue targets to loop headers
    std::map<std::uint32_t, Entry> entries_;                        // for reachable blocks
};

struct Module {
    std::vector<Instruction> globals;
    Functions functions;
    std::vector<std::uint32_t> order; // of the functions
    std::vector<std::uint32_t> entry_points;
};

bool read(const std::vector<std::uint32_t>& words, Module& m)
{
    if (words.size() < kHeader || words[0] != kMagic)
        return false;
    std::vector<Instruction>* body = nullptr;
    for (std::size_t at = kHeader; at < words.size();) {
        const Instruction i = {words.data() + at};
        if (i.count() == 0 || at + i.count() > words.size())
            return false;
        for (const auto& least : kLeast)
            if (i.op() == least.op && i.count() < least.words)
                return false;
        if (i.op() == kFunction) {
            m.order.push_back(i.words[2]);
            body = &m.functions[i.words[2]];
        }
        if (i.op() == kEntryPoint)
            m.entry_points.push_back(i.words[2]);
        (body ? *body : m.globals).push_back(i);
        if (i.op() == kFunctionEnd)
            body = nullptr;
        at += i.count();
    }
    return true;
}

Values constants_of(const Module& m, const std::vector<std::int32_t>& constants)
{
    Values values;
    std::map<std::uint32_t, std::uint32_t> spec_ids;
    for (const Instruction& i : m.globals) {
        if (i.op() == kDecorate && i.count() == 4 && i.words[2] == kSpecIdDecoration)
            spec_ids[i.words[1]] = i.words[3];
        const bool special = i.op() == kSpecConstant || i.op() == kSpecConstantTrue || i.op() == kSpecConstantFalse;
        if ((i.op() == kConstant || i.op() == kSpecConstant) && i.count() == 4)
            values[i.words[2]] = static_cast<std::int32_t>(i.words[3]);
        else if (i.op() == kConstantTrue || i.op() == kSpecConstantTrue || i.op() == kConstantFalse || i.op() == kSpecConstantFalse)
            values[i.words[2]] = i.op() == kConstantTrue || i.op() == kSpecConstantTrue;
        else if (i.op() == kSpecConstantOp && i.count() >= 5)
            if (const auto value = folded(values, i.words[3], i.words + 4, i.count() - 4))
                values[i.words[2]] = *value;
        if (const auto id = spec_ids.find(special ? i.words[2] : 0); id != spec_ids.end() && id->second < constants.size())
            values[i.words[2]] = constants[id->second];
    }
    return values;
}

} // namespace

std::vector<std::uint32_t> pruned(const std::vector<std::uint32_t>& words, const std::vector<std::int32_t>& constants)
{
    Module m;
    if (!read(words, m))
        return words;
    const Values values = constants_of(m, constants);
    std::map<std::uint32_t, std::vector<std::uint32_t>> kept; // words by function
    std::set<std::uint32_t> defined, all;
    std::vector<std::uint32_t> waiting = m.entry_points;
    // Walk all functions reachable from the entry points
    while (!waiting.empty()) {
        const std::uint32_t id = waiting.back();
        waiting.pop_back();
        const auto function = m.functions.find(id);
        if (kept.count(id))
            continue;
        if (function == m.functions.end())
            return words;
        Walk walk(function->second, m.functions, values);
        if (!walk.run())
            return words;
        kept[id] = std::move(walk.words);
        defined.insert(walk.defined.begin(), walk.defined.end());
        waiting.insert(waiting.end(), walk.calls.begin(), walk.calls.end());
    }
    // Drop names and decorations of removed ids
    for (const auto& [id, body] : m.functions)
        for (const Instruction& i : body)
            all.insert(i.result());
    std::vector<std::uint32_t> out(words.begin(), words.begin() + kHeader);
    for (const Instruction& i : m.globals) {
        const bool tells = i.op() == kName || i.op() == kDecorate; // refers to an id that may be gone
        if (!tells || !all.count(i.words[1]) || defined.count(i.words[1]))
            out.insert(out.end(), i.words, i.words + i.count());
    }
    for (const std::uint32_t id : m.order)
        if (const auto function = kept.find(id); function != kept.end())
            out.insert(out.end(), function->second.begin(), function->second.end());
    return out;
}

} // namespace burnish
