#include "raster/vulkan/prune.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "raster/vulkan/known_numbers.h"
#include "raster/vulkan/spirv.h"

namespace burnish {
namespace {

using namespace spirv;

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

// Values known in the whole module.
struct Given {
    Values constants;
    Buffers buffers;
};

// Known values at a point in a function.
struct Known {
    Values values;       // by id
    Values stored;       // by local variable
    Values pointed = {}; // by pointer into a buffer

    void evaluate(const Instruction& i, const std::set<std::uint32_t>& variables, const Buffers& buffers)
    {
        if (i.op() == kAccessChain) {
            if (const auto number = buffers.number_at(i, values))
                pointed[i.words[2]] = *number;
        } else if (i.op() == kLoad && pointed.count(i.words[3])) {
            values[i.words[2]] = pointed[i.words[3]];
        } else if (i.op() == kStore && variables.count(i.words[1])) {
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
using Arguments = std::vector<std::optional<std::int32_t>>;          // of a call, where they are known

// Leaves the arguments that this call shares with all noted ones.
void note(std::map<std::uint32_t, Arguments>& calls, std::uint32_t function, const Arguments& arguments)
{
    const auto [known, first] = calls.try_emplace(function, arguments);
    known->second.resize(std::min(known->second.size(), arguments.size()));
    for (std::size_t i = 0; !first && i < known->second.size(); ++i)
        if (known->second[i] != arguments[i])
            known->second[i].reset();
}

// Returns the value of a phi for a predecessor block, if it is known.
std::optional<std::int32_t> value_from(const Instruction& phi, std::uint32_t predecessor, const Values& values)
{
    for (std::uint32_t w = 3; w + 1 < phi.count(); w += 2)
        if (phi.words[w + 1] == predecessor)
            return value_in(values, phi.words[w]);
    return std::nullopt;
}

// Returns a function's result for known arguments, such as a test for a constant's bit. Unknown if a branch on the way is.
std::optional<std::int32_t> returned(const std::vector<Instruction>& body, const Given& given, const Arguments& arguments)
{
    Known known = {given.constants, {}};
    std::set<std::uint32_t> variables;
    std::map<std::uint32_t, std::size_t> blocks; // their places by label
    std::size_t parameters = 0;
    for (std::size_t at = 0; at < body.size(); ++at) {
        const Instruction& i = body[at];
        if (i.op() == kLabel)
            blocks[i.words[1]] = at;
        if (i.op() != kFunctionParameter)
            continue;
        if (parameters < arguments.size())
            if (const auto& value = arguments[parameters])
                known.stored[i.words[2]] = *value;
        ++parameters;
        variables.insert(i.words[2]);
    }
    std::uint32_t before = 0, label = 0; // blocks
    std::set<std::uint32_t> passed;
    for (std::size_t at = 0; at < body.size();) {
        const Instruction& i = body[at++];
        std::optional<std::uint32_t> to;
        switch (i.op()) {
        case kLabel:
            before = label, label = i.words[1];
            if (!passed.insert(label).second)
                return std::nullopt; // a loop
            break;
        case kPhi:
            if (const auto value = value_from(i, before, known.values))
                known.values[i.words[2]] = *value;
            break;
        case kReturnValue:
            return value_in(known.values, i.words[1]);
        case kFunctionCall:
            for (std::uint32_t w = 4; w < i.count(); ++w)
                known.stored.erase(i.words[w]); // the callee may write it
            break;
        case kBranch:
            to = i.words[1];
            break;
        case kBranchConditional:
            if (const auto condition = value_in(known.values, i.words[1]))
                to = i.words[*condition ? 2 : 3];
            else
                return std::nullopt;
            break;
        case kVariable:
            if (i.count() == 4 && i.words[3] == kFunctionStorage)
                variables.insert(i.words[2]);
            break;
        case kSwitch:
        case kKill:
        case kUnreachable:
        case kTerminateInvocation:
            return std::nullopt;
        default:
            known.evaluate(i, variables, given.buffers);
        }
        if (to) {
            const auto block = blocks.find(*to);
            if (block == blocks.end())
                return std::nullopt;
            at = block->second;
        }
    }
    return std::nullopt;
}

// Marks the reachable blocks of a function.
class Walk {
  public:
    // arguments: those that all calls of the function have in common.
    Walk(const std::vector<Instruction>& body, const Functions& functions, const Given& given, const Arguments& arguments)
        : body_(body), functions_(functions), given_(given), known_{given.constants, {}}
    {
        find_variables();
        find_changes();
        take(arguments);
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
                entries_[label].stored = known_.stored;
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
    std::map<std::uint32_t, Arguments> calls; // those that all calls of a function share
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
            if (i.op() == kFunctionParameter || (i.op() == kVariable && i.words[3] == kFunctionStorage))
                variables_.insert(i.words[2]);
        for (const Instruction& i : body_)
            for (std::uint32_t w = 1; w < i.count(); ++w)
                if (!((i.op() == kVariable || i.op() == kFunctionParameter) && w == 2) && !(i.op() == kLoad && w == 3) &&
                    !(i.op() == kStore && w == 1) && !(i.op() == kFunctionCall && w > 3))
                    variables_.erase(i.words[w]);
    }

    // Finds where the function may change local variables for the last time.
    void find_changes()
    {
        for (std::size_t at = 0; at < body_.size(); ++at) {
            const Instruction& i = body_[at];
            if (i.op() == kStore)
                last_change_[i.words[1]] = at;
            for (std::uint32_t w = 4; i.op() == kFunctionCall && w < i.count(); ++w)
                last_change_[i.words[w]] = at;
        }
    }

    // Parameters are pointers to variables of the caller, which nothing else reads meanwhile.
    void take(const Arguments& arguments)
    {
        std::size_t parameter = 0;
        for (const Instruction& i : body_)
            if (i.op() == kFunctionParameter && parameter++ < arguments.size() && arguments[parameter - 1] && variables_.count(i.words[2]))
                known_.stored[i.words[2]] = *arguments[parameter - 1];
    }

    void keep(const Instruction& i)
    {
        words.insert(words.end(), i.words, i.words + i.count());
        if (const std::uint32_t id = i.result())
            defined.push_back(id);
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
            for (const auto& [variable, change] : last_change_)
                if (change > begin) // may differ in the next iteration
                    known_.stored.erase(variable);
            headers_.insert(label), merges_.insert(merge->words[1]), continues_[merge->words[2]] = label;
        }
        keep(body_[begin]);
        for (std::size_t at = begin + 1; at + 1 < end; ++at) {
            const Instruction& i = body_[at];
            if (i.op() == kPhi) {
                if (loop)
                    return false;
                phi(label, i, entry.from);
            } else if (&i != merge) {
                i.op() == kFunctionCall ? call(i) : known_.evaluate(i, variables_, given_.buffers);
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
            if (last.words[2] != last.words[3]) {
                conditions_[{label, last.words[2]}] = {last.words[1], 1};
                conditions_[{label, last.words[3]}] = {last.words[1], 0};
            }
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

    void phi(std::uint32_t label, const Instruction& i, const std::vector<std::uint32_t>& from)
    {
        const std::size_t begin = words.size();
        words.insert(words.end(), i.words, i.words + 3);
        std::optional<std::int32_t> value;
        bool same = true;
        for (std::uint32_t w = 3; w + 1 < i.count(); w += 2) {
            if (std::find(from.begin(), from.end(), i.words[w + 1]) == from.end())
                continue;
            const auto coming = value_on_edge(i.words[w], i.words[w + 1], label);
            same = same && coming && (!value || *value == *coming);
            value = coming;
            words.insert(words.end(), {i.words[w], i.words[w + 1]});
        }
        words[begin] = static_cast<std::uint32_t>(words.size() - begin) << 16 | kPhi;
        defined.push_back(i.words[2]);
        if (same && value)
            known_.values[i.words[2]] = *value;
    }

    // Returns an id's value on the way from one block to another: a branch tells its own condition.
    std::optional<std::int32_t> value_on_edge(std::uint32_t id, std::uint32_t from, std::uint32_t to) const
    {
        const auto condition = conditions_.find({from, to});
        return condition != conditions_.end() && condition->second.first == id ? std::optional(condition->second.second)
                                                                               : value_in(known_.values, id);
    }

    void call(const Instruction& i)
    {
        Arguments arguments;
        for (std::uint32_t w = 4; w < i.count(); ++w) {
            arguments.push_back(value_in(known_.stored, i.words[w]));
            known_.stored.erase(i.words[w]); // the callee may write it
        }
        note(calls, i.words[3], arguments);
        const auto function = functions_.find(i.words[3]);
        if (function == functions_.end())
            return;
        if (const auto value = returned(function->second, given_, arguments))
            known_.values[i.words[2]] = *value;
    }

    const std::vector<Instruction>& body_;
    const Functions& functions_;
    const Given& given_;
    Known known_;                                       // in the current block
    std::set<std::uint32_t> variables_;                 // ids
    std::map<std::uint32_t, std::size_t> last_change_;  // places in the body by variable
    std::set<std::uint32_t> passed_, headers_, merges_; // blocks
    std::map<std::uint32_t, std::uint32_t> continues_;  // maps continue targets to loop headers
    std::map<std::uint32_t, Entry> entries_;            // for reachable blocks
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::int32_t>> conditions_; // ids and values by edge
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

// Appends a function behind all that it calls.
void add_calls(const Functions& functions, std::uint32_t id, std::set<std::uint32_t>& passed, std::vector<std::uint32_t>& to)
{
    const auto function = functions.find(id);
    if (function == functions.end() || !passed.insert(id).second)
        return;
    for (const Instruction& i : function->second)
        if (i.op() == kFunctionCall)
            add_calls(functions, i.words[3], passed, to);
    to.push_back(id);
}

// Returns the functions, each behind all that call it.
std::vector<std::uint32_t> callers_first(const Module& m)
{
    std::vector<std::uint32_t> order;
    std::set<std::uint32_t> passed;
    for (const std::uint32_t entry : m.entry_points)
        add_calls(m.functions, entry, passed, order);
    std::reverse(order.begin(), order.end());
    return order;
}

} // namespace

std::vector<std::uint32_t> pruned(const std::vector<std::uint32_t>& words, const std::vector<std::int32_t>& constants,
                                  const std::vector<KnownNumber>& numbers)
{
    Module m;
    if (!read(words, m))
        return words;
    const Given given = {constants_of(m, constants), Buffers(m.globals, numbers)};
    std::map<std::uint32_t, std::vector<std::uint32_t>> kept; // words by function
    std::set<std::uint32_t> defined, all;
    std::map<std::uint32_t, Arguments> called; // those that all calls of a function share
    for (const std::uint32_t entry : m.entry_points) {
        if (!m.functions.count(entry))
            return words;
        called[entry] = {};
    }
    // Walk all functions that are reached from the entry points
    for (const std::uint32_t id : callers_first(m)) {
        const auto arguments = called.find(id);
        if (arguments == called.end())
            continue;
        Walk walk(m.functions.at(id), m.functions, given, arguments->second);
        if (!walk.run())
            return words;
        kept[id] = std::move(walk.words);
        defined.insert(walk.defined.begin(), walk.defined.end());
        for (const auto& [function, own] : walk.calls) {
            if (!m.functions.count(function))
                return words;
            note(called, function, own);
        }
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
