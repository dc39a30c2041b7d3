// Selects the instruction set for lane code. Each file of bn_isa_objects is compiled once for each line of isa_list.h.
// Each copy exports a table of plain functions, and pick<Fns>() chooses one table.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/check.h"
#include "core/base/result.h"
#include "core/simd/fns.h"

namespace burnish {

#define BN_ISA_VALUE(name, use, runs, flags, of) name,
enum class Isa { BN_EACH_ISA(BN_ISA_VALUE, ) };
#undef BN_ISA_VALUE

const char* isa_name(Isa isa);                  // the name in isa_list.h
bool isa_available(Isa isa);                    // true where this processor and its operating system run the set
const std::vector<Isa>& all_isas();             // from narrow to wide
const std::vector<Isa>& program_isas();         // the sets that options know, available here or not
Result<Isa> parse_isa(const std::string& name); // accepts the program's sets only
Isa best_isa();                                 // the widest available set of the program, at most $BN_FORCE_ISA

// Returns the set's table, or null where this processor cannot run the set or the table is not linked.
template <class Fns> const Fns* find_fns(Isa isa)
{
    const auto table = FnsByIsa<Fns>::of[static_cast<std::size_t>(isa)];
    return table && isa_available(isa) ? &table(nullptr) : nullptr;
}
template <class Fns> const Fns& oracle_fns()
{
    return FnsByIsa<Fns>::oracle(nullptr);
}
template <class Fns> const Fns& counted_fns()
{
    return FnsByIsa<Fns>::counted(nullptr);
}
template <class Fns> const Fns& pick(Isa isa = best_isa())
{
    const Fns* fns = find_fns<Fns>(isa);
    BN_CHECK(fns != nullptr);
    return *fns;
}
// Lists the sets whose tables find_fns finds, from narrow to wide.
template <class Fns> std::vector<Isa> isas_with()
{
    std::vector<Isa> found;
    for (const Isa isa : all_isas())
        if (find_fns<Fns>(isa))
            found.push_back(isa);
    return found;
}

} // namespace burnish
