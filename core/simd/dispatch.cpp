#include "core/simd/dispatch.h"

#include <cstdlib>

#include "core/simd/cpu.h"

namespace burnish {
namespace {

enum class Use { program, tests };
struct Row {
    const char* name;
    Use use;
    bool (*runs)();
};
#define BN_ROW(name, use, runs, flags, of) {#name, Use::use, [] { return runs; }},
constexpr Row kRows[] = {BN_EACH_ISA(BN_ROW, )};

const Row& row_of(Isa isa)
{
    return kRows[static_cast<std::size_t>(isa)];
}

} // namespace

const char* isa_name(Isa isa)
{
    return row_of(isa).name;
}

bool isa_available(Isa isa)
{
    return row_of(isa).runs();
}

const std::vector<Isa>& all_isas()
{
    static const std::vector<Isa> isas = [] {
        std::vector<Isa> list;
        for (std::size_t i = 0; i < sizeof kRows / sizeof kRows[0]; ++i)
            list.push_back(static_cast<Isa>(i));
        return list;
    }();
    return isas;
}

const std::vector<Isa>& program_isas()
{
    static const std::vector<Isa> isas = [] {
        std::vector<Isa> list;
        for (const Isa isa : all_isas())
            if (row_of(isa).use == Use::program)
                list.push_back(isa);
        return list;
    }();
    return isas;
}

Result<Isa> parse_isa(const std::string& name)
{
    std::string names;
    for (const Isa isa : program_isas()) {
        if (name == isa_name(isa))
            return isa;
        names += (names.empty() ? "" : ", ") + std::string(isa_name(isa));
    }
    return Error{ExitCode::usage, "", "", "unknown instruction set '" + name + "'; there are " + names};
}

Isa best_isa()
{
    Isa cap = program_isas().back();
    if (const char* forced = std::getenv("BN_FORCE_ISA"))
        if (const Result<Isa> isa = parse_isa(forced))
            cap = *isa;
    Isa best = program_isas().front();
    for (const Isa isa : program_isas())
        if (isa <= cap && isa_available(isa))
            best = isa;
    return best;
}

} // namespace burnish
