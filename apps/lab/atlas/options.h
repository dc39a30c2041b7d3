// Options of `burnish atlas`.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "apps/lab/atlas/measure.h"
#include "apps/pieces/pieces.h"
#include "core/simd/dispatch.h"

namespace burnish {

struct AtlasOptions {
    std::vector<std::string> ids; // empty: all entries
    std::string folder, json;     // empty: no output
    std::string table;            // golden figures; empty: the built-in table
    std::string with;             // see AtlasEntry
    std::string renderer;         // of the page, with live
    PieceOptions pieces;
    bool list = false, quick = false, bless = false, live = false, use_cache = true, quiet = false;
    int threads = 0, verbosity = 0;
    Isa isa = {};

    const AtlasWalk& walk() const { return quick ? kQuickWalk : kFullWalk; }
    std::vector<AtlasEntry> entries() const; // in the order of atlas.def
};

OptionTable atlas_option_table(AtlasOptions& to);
Status check_atlas_options(AtlasOptions& options, const OptionTable& given);

} // namespace burnish
