// `burnish merge`: puts the pieces of a job together.
#include <cstdio>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/program.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/pieces/pieces.h"

namespace burnish {
namespace {

constexpr const char* kMergeFooter =
    R"(DIR holds the pieces that --shard, --take and --piece of a command made, and the command. The same files as by one process are written,
whatever the shares and their order. Run it where the command ran, as its paths count from there. Where pieces are missing, the exit code
is 5, and standard output has a command for each.

Examples:
  burnish render lamp.glb --backend reference --samples 4096 -o lamp.exr --shard 1/2 --work pieces
  burnish render lamp.glb --backend reference --samples 4096 -o lamp.exr --shard 2/2 --work pieces
  burnish merge pieces)";

struct MergeArguments {
    std::vector<std::string> folders, outputs;
    bool quiet = false;
};

int run_merge(const MergeArguments& given)
{
    Result<std::vector<std::string>> words = job_of(given.folders);
    if (!words)
        return fail(words.error());
    words->push_back("--merge");
    for (const std::string& folder : given.folders)
        words->insert(words->end(), {"--work", folder});
    for (const std::string& output : given.outputs)
        words->insert(words->end(), {"-o", output});
    if (given.quiet)
        words->push_back("--quiet");
    return run_words(*words);
}

} // namespace

Command merge_command()
{
    auto given = std::make_shared<MergeArguments>();
    OptionTable table;
    table.add("", {Option("DIR", "", "Folder of pieces; several are searched in turn", texts(given->folders)).must_be_given()});
    table.add("Output",
              {Option("-o,--output", "FILE", "Write this too, in a format of the command; a chart goes here instead", files(given->outputs))
                   .is_output(),
               quiet_option(given->quiet)});
    return {"merge", "Put the pieces of a job together", std::move(table), kMergeFooter,
            [given](OptionTable&) { return run_merge(*given); }};
}

} // namespace burnish
