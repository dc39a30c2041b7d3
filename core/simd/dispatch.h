// Which instruction set runs lane code. Files of bn_isa_objects are compiled once for each line of isa_list.h; every copy gives the rest of
// the program a table of plain functions, and pick<Fns>() chooses one of them.
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

const char* isa_name(Isa isa);                  // as in the list
bool isa_available(Isa isa);                    // this processor and its operating system run it
const std::vector<Isa>& all_isas();             // from narrow to wide
const std::vector<Isa>& program_isas();         // of these: those that options know, whether they run here or not
Result<Isa> parse_isa(const std::string& name); // one of the program's
Isa best_isa();                                 // the widest of the program's that runs, no wider than BN_FORCE_ISA in the environment says

// The table of an instruction set; null where this processor cannot run it, or where it is not linked.
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
// Those that find_fns finds, from narrow to wide.
template <class Fns> std::vector<Isa> isas_with()
{
    std::vector<Isa> found;
    for (const Isa isa : all_isas())
        if (find_fns<Fns>(isa))
            found.push_back(isa);
    return found;
}

} // namespace burnish
