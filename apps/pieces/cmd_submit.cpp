// `burnish submit`: prints a script that runs a job's pieces under a cluster's engine.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"
#include "apps/pieces/pieces.h"
#include "apps/pieces/submit.h"

namespace burnish {
namespace {

constexpr const char* kSubmitFooter =
    R"(The command stands behind "--". Slurm's tasks take pieces from each other's rest, so a slow or dead one holds nobody. All scripts end with
a merge, which makes what is missing and judges. The folder of the pieces must be one that all machines see.

Examples:
  burnish submit --for slurm --shards 8 -- chart lamp.glb --runs 0 -o report | sh
  burnish submit --for parallel --at-once 2 -- render lamp.glb --backend reference --samples 4096 -o lamp.exr)";

int run_submit(const SubmitOptions& given)
{
    constexpr const char* kWithPieces[] = {"render", "chart"};
    SubmitOptions options = given;
    options.words = without_pieces(given.words);
    if (options.words.size() != given.words.size())
        return fail(usage_error("COMMAND", "has options of pieces, which the script brings"));
    if (std::none_of(std::begin(kWithPieces), std::end(kWithPieces), [&](const char* name) { return options.words[0] == name; }))
        return fail(usage_error("COMMAND", "'" + options.words[0] + "' has no pieces: render and chart have"));
    std::fputs(submit_script(options).c_str(), stdout);
    return 0;
}

} // namespace

Command submit_command()
{
    auto options = std::make_shared<SubmitOptions>();
    OptionTable table;
    table.add("", {Option("COMMAND", "", "A subcommand and its options, behind --", texts(options->words)).must_be_given()});
    table.add("Script",
              {Option("--for", "ENGINE", "What runs the pieces: {}", choice(options->engine, submit_engines()), "").must_be_given(),
               Option("--shards", "N", "Number of processes", integer(options->shards, 1, 100000)),
               Option("--at-once", "N", "Processes at a time", integer(options->at_once, 1, 100000), "all"),
               Option("--work", "DIR", "Folder of the pieces", folder(options->work))});
    return {"submit", "Print a script that runs a job's pieces under a cluster's engine", std::move(table), kSubmitFooter,
            [options](OptionTable&) { return run_submit(*options); }};
}

} // namespace burnish
