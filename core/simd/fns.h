// Tables of functions that lane code exports to the rest of the program. BN_DECLARE_FNS(Fns), in namespace burnish,
// declares a table Fns for each instruction set, for pick<Fns>() (dispatch.h). BN_DEFINE_FNS(Fns, table), at the end of
// a bn_isa_objects file and in namespace BN_ISA_NS, defines the set's table. The tables hold plain pointers, because
// lane code sees no containers.
#pragma once
#include "core/simd/isa_list.h"

namespace burnish {

template <class Fns> struct FnsByIsa;

#define BN_DECLARE_FNS(Fns)                                                                                                                \
    BN_EACH_ISA(BN_DECLARE_FNS_OF, Fns)                                                                                                    \
    BN_EACH_TWIN(BN_DECLARE_FNS_OF, Fns)                                                                                                   \
    template <> struct FnsByIsa<Fns> {                                                                                                     \
        using Get = const Fns& (*)(const Fns*);                                                                                            \
        static constexpr Get of[] = {BN_EACH_ISA(BN_FNS_OF, Fns)};                                                                         \
        static constexpr Get oracle = &bn_oracle::isa_fns, counted = &bn_counted::isa_fns, mutated = &bn_mutated::isa_fns;                 \
    }
#define BN_DECLARE_FNS_OF(name, use, runs, flags, Fns)                                                                                     \
    inline namespace bn_##name                                                                                                             \
    {                                                                                                                                      \
        BN_LINK_##use const Fns& isa_fns(const Fns*);                                                                                      \
    }
#define BN_FNS_OF(name, use, runs, flags, Fns) &bn_##name::isa_fns,
#define BN_LINK_program
#define BN_LINK_tests __attribute__((weak)) // null where the table is not linked

#define BN_DEFINE_FNS(Fns, table)                                                                                                          \
    const Fns& isa_fns(const Fns*);                                                                                                        \
    const Fns& isa_fns(const Fns*)                                                                                                         \
    {                                                                                                                                      \
        return table;                                                                                                                      \
    }

} // namespace burnish
