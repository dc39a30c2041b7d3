// `burnish golden`: makes pictures, compares them with golden ones, and lets people bless changes.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <system_error>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/suggest.h"
#include "apps/cli/values.h"
#include "apps/cli/words.h"
#include "apps/golden/golden_pieces.h"
#include "apps/golden/tasks.h"
#include "apps/live/live.h"
#include "apps/pieces/words.h"
#include "core/jobs/cores.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    R"~(check MANIFEST.json: makes the manifest's pictures and compares them with their goldens. check EXPECTED ACTUAL: compares two folders,
or the files of two quoted patterns with one * in the file name.
bless: takes over new pictures of the last check that differ or have no golden; with --from, only the list's pictures.
merge FOLDER...: joins the results of shards to the files of one run.
With --shard and --work, --take or --piece, a row is a piece in a folder that processes share, and --merge writes the results. A row that
failed is a piece too, unless the machine may be the cause: a full disk, a program that is killed or takes too long. A program's row counts by
its words and the files that they name, but not by folders.

A manifest is a JSON object. "rows" lists pictures:
  {"name": "pot", "scene": "builtin:teapot", "options": ["--size", "320x180"]}      drawn by burnish render
  {"name": "page", "command": ["node", "draw.js"], "picture": "out/page.png"}       drawn by any program
  {"name": "old", "picture": "out/old.exr"}                                         there already
Rows may have "hold", limits in place of equal values: {"flip": MEAN, "flip_p99": F, "pattern": RMS, "z": SHARE}. "operations": N beside
them limits a frame's float operations, a count that is equal on every machine. "mask" is a picture whose black pixels do not count.
"keep": "hash" makes the golden a hash. Further members: "seconds" (300), "environment" (variables), "format" of
scenes (png), "golden" (goldens/NAME.png). "defaults" holds the same members, and "options" of scenes. Paths are relative to the manifest, and
programs run beside it.

The results' folder gets index.html with the differences, results.jsonl, junit.xml, summary.md, all new pictures and the programs' output. On
GitHub, annotations and the step's summary are written too.

Exit codes, the gravest first: 4 a picture could not be made or the manifest is wrong, 6 a picture holds NaN or Inf, 1 a picture differs,
5 a golden is missing, or a shard to merge, 0 all passed.

Examples:
  burnish golden check goldens.json
  burnish golden check goldens.json --jobs 4 --shard 2/3 -o shard-2
  burnish golden merge shard-1 shard-2 shard-3 -o golden-results
  burnish golden check goldens.json --take --work pieces
  burnish golden check goldens.json --merge --work pieces
  burnish golden bless goldens.json --from bless.txt
  burnish golden check expected actual --flip 0.01
  burnish golden check 'out/*_golden.png' 'out/*_now.png' --mask mask.png)~";

// Returns this command without its shard, its folder and its job count.
std::vector<std::string> words_of_shard()
{
    const std::vector<std::string> words = without_pieces(command_words());
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool apart = words[i] == "-o" || words[i] == "--output" || words[i] == "--jobs";
        if (apart)
            ++i;
        else if (!words[i].starts_with("-o") && !words[i].starts_with("--output=") && !words[i].starts_with("--jobs="))
            kept.push_back(words[i]);
    }
    return kept;
}

// Returns true if the command deals in pieces: --shard alone makes a result folder.
bool wants_pieces(const PieceOptions& pieces)
{
    return any_pieces(pieces) && (pieces.shard.empty() || !pieces.folders.empty());
}

GoldenSetting setting_of(const GoldenArguments& arguments, const std::string& results)
{
    GoldenSetting setting;
    setting.results = results, setting.limits = arguments.input, setting.stop = &watch_stop_signals();
    std::error_code ignored;
    setting.program = fs::read_symlink("/proc/self/exe", ignored).string();
    std::signal(SIGCHLD, SIG_DFL); // an ignored signal would hide how programs end
    return setting;
}

// Makes some rows, or puts finished ones together. of_all: manifest_hash() over all rows.
int check_in_pieces(const GoldenArguments& arguments, const GoldenManifest& manifest, const std::string& of_all, Report& report)
{
    if (arguments.jobs > 0)
        return fail(usage_error("--jobs", "a process makes its pieces one after the other; several processes may use --take"));
    const GoldenSetting setting = setting_of(arguments, "");
    const Jobs jobs(1);
    const Result<std::vector<JobPiece>> pieces = golden_pieces(manifest, setting, jobs);
    if (!pieces)
        return fail(pieces.error());
    if (!arguments.pieces.merge)
        return run_pieces(arguments.pieces, command_words(), *pieces, report);
    const auto files = finished_pieces(arguments.pieces, command_words(), *pieces);
    if (!files)
        return fail(files.error());
    NewResults fresh(arguments.results);
    if (const Status made = fresh.make(inputs_of(arguments, manifest), {Share(), of_all}); !made)
        return fail(made.error());
    Result<std::vector<GoldenResult>> results = take_golden_pieces(manifest, *files, *pieces, fresh.folder());
    if (!results)
        return fail(results.error());
    report.promise_stdout({"-"}); // to missing pieces' commands
    report.release();
    return conclude_golden(std::move(*results), &manifest, fresh, arguments, report);
}

// Keeps the rows that the user names.
Status keep_rows(const std::vector<std::string>& names, GoldenManifest& manifest)
{
    std::vector<std::string> known;
    for (const GoldenRow& row : manifest.rows)
        known.push_back(row.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            return usage_error("--row", "there is no row '" + printable(name) + "'" + did_you_mean(name, known));
    std::erase_if(manifest.rows, [&](const GoldenRow& row) { return std::find(names.begin(), names.end(), row.name) == names.end(); });
    return {};
}

// Warns about rows without a tolerance whose bits depend on the machine.
void warn_of_machines(const GoldenManifest& manifest, Report& report)
{
    for (const GoldenRow& row : manifest.rows)
        if (row.kind == GoldenKind::scene && row.limits.exact()) {
            const std::string words = " " + shell_words(row.command) + " ";
            for (const char* option : {"--backend reference", "--backend vulkan", "--budget-ms"})
                if (words.find(fmt::format(" {}", option)) != words.npos)
                    report.warning(fmt::format("row '{}': {} may draw other bits on another machine; \"hold\" gives it a tolerance",
                                               row.name, option));
        }
}

int check(const GoldenArguments& arguments, Report& report)
{
    if (const Status pieces = check_piece_options(arguments.pieces); !pieces)
        return fail(pieces.error());
    const Result<Share> shard = arguments.pieces.shard.empty() ? Result<Share>(Share()) : parse_share(arguments.pieces.shard);
    if (!shard)
        return fail(shard.error());
    if (arguments.live)
        if (const Status found = check_renderer(arguments.renderer); !found)
            return fail(found.error());
    Result<GoldenManifest> manifest = manifest_at(arguments);
    if (!manifest)
        return fail(manifest.error());
    const std::string of_all = manifest_hash(*manifest); // also with some rows: bless looks for changes in the manifest
    if (!arguments.rows.empty())
        if (const Status kept = keep_rows(arguments.rows, *manifest); !kept)
            return fail(kept.error());
    warn_of_machines(*manifest, report);
    if (wants_pieces(arguments.pieces))
        return check_in_pieces(arguments, *manifest, of_all, report);
    std::vector<GoldenRow> rows;
    for (std::size_t i = 0; i < manifest->rows.size(); ++i)
        if (shard->holds(i))
            rows.push_back(manifest->rows[i]);
    NewResults fresh(arguments.results);
    if (const Status made =
            fresh.make(inputs_of(arguments, *manifest), {*shard, of_all, shard->count > 1 ? words_of_shard() : std::vector<std::string>()});
        !made)
        return fail(made.error());
    report.release();
    // Make and judge the rows
    const GoldenSetting setting = setting_of(arguments, fresh.folder());
    const int wanted = arguments.jobs > 0 ? arguments.jobs : usable_cores();
    const Jobs side_by_side(std::max(1, std::min(wanted, static_cast<int>(rows.size()))));
    std::vector<GoldenResult> results(rows.size());
    Progress progress("golden pictures", rows.size(), arguments.quiet);
    side_by_side.parallel_for(rows.size(), [&](std::size_t i, int) {
        const Jobs jobs(1);
        results[i] = check_row(*manifest, rows[i], setting, jobs);
        progress.step();
    });
    if (*setting.stop)
        return 128 + stop_signal();
    return conclude_golden(std::move(results), &*manifest, fresh, arguments, report);
}

int run_golden(const GoldenArguments& arguments, const OptionTable& given)
{
    Report report(arguments.quiet, arguments.verbosity);
    using enum GoldenTask;
    for (const auto& [option, task] : {std::pair{"--from", bless},
                                       {"--shard", check_rows},
                                       {"--pieces", check_rows},
                                       {"--take", check_rows},
                                       {"--piece", check_rows},
                                       {"--merge", check_rows},
                                       {"--work", check_rows},
                                       {"--jobs", check_rows},
                                       {"--row", check_rows},
                                       {"--live", check_rows},
                                       {"--renderer", check_rows}})
        if (given.given(option) && arguments.task != task)
            return fail(usage_error(option, fmt::format("belongs to `golden {}`", task == bless ? "bless" : "check")));
    switch (arguments.task) {
    case check_rows:
        return check(arguments, report);
    case bless:
        return bless_goldens(arguments, report);
    case merge:
        report.promise_stdout({"-"}); // to missing shards' commands
        return merge_golden_shards(arguments, report);
    }
    return 0;
}

// Returns the options for pieces. A shard without a piece folder makes results for `golden merge`.
std::vector<Option> golden_piece_options(PieceOptions& to)
{
    std::vector<Option> options = piece_options(to);
    for (Option& option : options)
        if (option.name == "--shard")
            option.help = "Makes every N-th row, from the I-th, as a folder of results for golden merge; with --work, as pieces; auto: as "
                          "the engine's environment says; auto/N: its index, of N";
        else if (option.name == "--merge")
            option.help = "Put the pieces together, as one check does";
    return options;
}

OptionTable golden_option_table(GoldenArguments& to)
{
    OptionTable table;
    table.add(
        "", {{"WHAT", "", "{}", choice(to.task, {"check", "bless", "merge"})},
             Option("PATH", "", "A manifest, two folders or patterns of expected and actual pictures, or results to merge", files(to.paths))
                 .must_be_given()});
    table.add("Goldens",
              {{"-o,--output", "FOLDER", "Folder of the results", folder(to.results)},
               {"--jobs", "N", "Pictures made side by side", integer(to.jobs, 1, 1024), "all cores"},
               {"--row", "NAME", "check: makes this row alone; may be given several times", texts(to.rows), "all rows"},
               {"--live", "", "check: put the renderer into the page, which then draws scenes that differ anew: see burnish export page",
                flag(to.live)},
               {"--renderer", "FOLDER", "With --live: folder of the npm package, with burnish_core.wasm", folder(to.renderer),
                "beside the program"},
               {"--from", "LIST", "File with names of rows to bless, one a line, as the page saves it", file(to.from), ""},
               {"--flip", "MEAN", "Of folders and patterns: mean FLIP that pictures may differ by, {}", number(to.limits.flip, 0.0, 1.0),
                "not a single value"},
               {"--flip-p99", "F", "Of folders and patterns: 99th percentile of FLIP that pictures may have, {}",
                number(to.limits.flip_p99, 0.0, 1.0), ""},
               {"--pattern", "RMS", "Of folders and patterns: RMS of patterns that pictures may have, {}",
                number(to.limits.pattern, 0.0, 100.0), ""},
               {"--mask", "FILE|FOLDER",
                "Of folders and patterns: picture whose black pixels do not count, or a folder of them by the pictures' names",
                file(to.mask), ""},
               quiet_option(to.quiet),
               verbose_option(to.verbosity)});
    table.add("Pieces, for many processes", golden_piece_options(to.pieces));
    table.add("Limits on input", limit_options(to.input));
    return table;
}

} // namespace

Command golden_command()
{
    auto arguments = std::make_shared<GoldenArguments>();
    return {"golden", "Compare many pictures with golden ones, and bless changes", golden_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_golden(*arguments, given); }};
}

} // namespace burnish
