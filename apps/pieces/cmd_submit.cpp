// `burnish submit`: prints a script that runs a job's pieces under a cluster's engine.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"
#include "apps/pieces/submit.h"
#include "apps/pieces/words.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

constexpr const char* kSubmitFooter =
    R"(The command stands behind "--". Tasks of slurm and k8s take pieces from each other's rest, so a slow or dead one holds nobody. All scripts
end with a merge, which judges, and makes what is missing. The folder of the pieces must be one that all machines see.

Examples:
  burnish submit --for slurm --shards 8 -- chart lamp.glb --runs 0 -o report | sh
  burnish submit --for parallel --at-once 2 -- render lamp.glb --backend reference --samples 4096 -o lamp.exr)";

// Returns true for a size that is drawn in bands.
bool is_large(const std::vector<std::string>& words)
{
    const auto at =
        std::find_if(words.begin(), words.end(), [](const std::string& w) { return w == "--size" || w.starts_with("--size="); });
    if (at == words.end() || (*at == "--size" && at + 1 == words.end()))
        return false;
    const std::string size = *at == "--size" ? at[1] : at->substr(std::strlen("--size="));
    const std::size_t cross = size.find('x');
    const std::int64_t width = std::atoll(size.c_str()), height = cross == size.npos ? 0 : std::atoll(size.c_str() + cross + 1);
    std::int64_t samples = FrameDesc().msaa;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i].starts_with("--msaa"))
            samples = std::atoll(words[i] == "--msaa" ? i + 1 < words.size() ? words[i + 1].c_str() : ""
                                                      : words[i].c_str() + std::strlen("--msaa="));
    return width > kMaxPictureSide || height > kMaxPictureSide || width * height * samples > kMaxPictureSamples;
}

// Returns true if a command has pieces: a reference, a row of pictures, bands, a chart of frames, an atlas. Also references for engines,
// levels, a table, nets, and goldens.
bool has_pieces(const std::vector<std::string>& words)
{
    const auto has = [&](const std::string& option) {
        return std::any_of(words.begin(), words.end(), [&](const std::string& w) { return w == option || w.starts_with(option + "="); });
    };
    const auto backend = std::find(words.begin(), words.end(), "--backend");
    const bool reference =
        (backend != words.end() && backend + 1 != words.end() && backend[1] == "reference") || has("--backend=reference");
    if (words[0] == "render")
        return reference || has("--animate") || has("--turntable") || has("--band-rows") || is_large(words);
    if (words[0] == "bake" && words.size() > 1)
        return words[1] == "mip" || (words[1] == "ltc" && !has("--table"));
    if (words[0] == "golden")
        return words.size() > 2 && words[1] == "check";
    if (words[0] == "train")
        return true;
    return (words[0] == "chart" && !has("--mip")) || (words[0] == "atlas" && !has("--list")) || (words[0] == "conform" && has("--write"));
}

int run_submit(const SubmitOptions& given)
{
    SubmitOptions options = given;
    options.words = without_pieces(given.words);
    if (options.words.size() != given.words.size())
        return fail(usage_error("COMMAND", "has options of pieces, which the script brings"));
    if (!has_pieces(options.words))
        return fail(usage_error(
            "COMMAND",
            "has no pieces: render --backend reference, --animate, --turntable and --band-rows, chart, atlas, conform --write, bake mip, "
            "bake ltc, train mip and golden check have"));
    for (const std::string option : {"--checkpoint", "--target-error"})
        if (std::any_of(options.words.begin(), options.words.end(),
                        [&](const std::string& w) { return w == option || w.starts_with(option + "="); }))
            return fail(usage_error("COMMAND", "has " + option + ", which is of a single process"));
    if (options.words[0] == "golden" && std::any_of(options.words.begin(), options.words.end(),
                                                    [](const std::string& w) { return w == "--jobs" || w.starts_with("--jobs="); }))
        return fail(usage_error("COMMAND", "has --jobs, and a process makes its pieces one after the other"));
    if (const Status taken = check_submit(options); !taken)
        return fail(taken.error());
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
