// Options of `burnish atlas`.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/lab/atlas/measure.h"
#include "core/simd/dispatch.h"

namespace burnish {

struct AtlasOptions {
    std::vector<std::string> ids; // empty: all
    std::string folder, json;     // empty: none
    std::string table;            // blessed figures; empty: the program's own
    std::string with;             // as in AtlasEntry
    bool list = false, quick = false, bless = false, use_cache = true, quiet = false;
    int threads = 0, verbosity = 0;
    Isa isa = Isa::scalar;

    const AtlasWalk& walk() const { return quick ? kQuickWalk : kFullWalk; }
    std::vector<AtlasEntry> entries() const; // in the order of atlas.def
};

OptionTable atlas_option_table(AtlasOptions& to);
Status check_atlas_options(AtlasOptions& options, const OptionTable& given);

} // namespace burnish
