#include "apps/lab/atlas/options.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/suggest.h"
#include "apps/cli/values.h"

namespace burnish {
namespace {

Value entry_names(std::vector<std::string>& to)
{
    Value value;
    value.kind = ValueKind::name, value.repeated = true, value.names = entry_ids();
    value.set = [&to](const std::string&, const std::vector<std::string>& texts) -> Status {
        for (const std::string& text : texts)
            if (!find_entry(text))
                return usage_error("ID", fmt::format("no entry '{}'{} (see burnish atlas --list)", text, did_you_mean(text, entry_ids())));
        to = texts;
        return {};
    };
    value.get = [] { return std::string(); };
    return value;
}

} // namespace

OptionTable atlas_option_table(AtlasOptions& to)
{
    OptionTable table;
    table.add("",
              {{"ID", "", "Entries to measure; may be several; all if none is given", entry_names(to.ids)},
               {"--list", "", "Print the entries with the failure that each shows", flag(to.list)},
               {"--quick", "", "Take 7 steps with small pictures instead of 33 with larger ones, and compare with their own golden figures",
                flag(to.quick)},
               {"--with", "WORDS", "Further options of burnish render for the failing picture and its cure, to try a change", text(to.with),
                ""}});
    table.add("Output",
              {{"-o,--output", "DIR", "Folder for index.html and atlas.json, created if missing", folder(to.folder)},
               {"--live", "", "Put the renderer into the page, which then draws each entry's worst place anew: see burnish export page",
                flag(to.live)},
               {"--renderer", "FOLDER", "With --live: folder of the npm package, with burnish_core.wasm", folder(to.renderer),
                "build/wasm/package"},
               {"--json", "FILE", "Figures as JSON; - for standard output", file(to.json)},
               {"--table", "FILE", "Golden figures to compare with", file(to.table), "the program's own"},
               {"--bless", "", "Write the measured figures into --table; other entries stay as they are", flag(to.bless)},
               quiet_option(to.quiet),
               verbose_option(to.verbosity)});
    table.add("Pieces, for several processes", piece_options(to.pieces));
    table.add("Machine", {threads_option(to.threads),
                          isa_option(to.isa, "Instruction set: {}; never changes the figures"),
                          {"--no-cache", "", "Use no cache of environments and references", flag(to.use_cache, false)}});
    return table;
}

Status check_atlas_options(AtlasOptions& options, const OptionTable& given)
{
    BN_TRY(check_piece_options(options.pieces));
    if (options.bless && any_pieces(options.pieces) && !options.pieces.merge)
        return usage_error("--bless", "is for the merge");
    if (options.live && options.folder.empty())
        return usage_error("--live", "needs -o DIR, whose page it is for");
    if (given.given("--renderer") && !options.live)
        return usage_error("--renderer", "needs --live");
    if (options.bless && options.table.empty())
        return usage_error("--bless", "needs --table, the file that is written");
    if (options.bless && !options.with.empty())
        return usage_error("--with", "cannot be combined with --bless: a trial is not blessed");
    for (const AtlasEntry& entry : options.entries())
        if (const Result<AtlasSetting> setting = setting_of(entry, AtlasRole::test, 1.0, kQuickWalk.side, 0); !setting)
            return Error{ExitCode::usage, "", "--with", setting.error().reason};
    if (!options.json.empty())
        BN_TRY(check_text_path("--json", options.json, {options.table}));
    if (options.bless)
        BN_TRY(check_text_path("--table", options.table, {}));
    const Result<Isa> isa = choose_isa(given, options.isa);
    BN_TRY(isa);
    options.isa = *isa;
    return {};
}

std::vector<AtlasEntry> AtlasOptions::entries() const
{
    std::vector<AtlasEntry> out;
    for (const AtlasEntry& entry : atlas_entries())
        if (ids.empty() || std::find(ids.begin(), ids.end(), entry.id) != ids.end())
            out.push_back(entry), out.back().with = with;
    return out;
}

} // namespace burnish
