#include "apps/pieces/submit.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/pieces/pieces.h"

namespace burnish {
namespace {

// Places in a template: @COMMAND@, the burnish command as shell words; @JOB@, the same as one shell word with its share; @WORK@; @SHARDS@;
// @LAST@, one less; @MOST@, as many as run at once; @SHARES@, 1, 2, ... with commas; @YAML@, the command's words as a list in JSON;
// @MERGE@, a shell line that merges, makes what is missing, and merges again.
struct Script {
    const char *name, *text;
};
constexpr Script kScripts[] = {
    {"slurm", R"(#!/bin/sh
# Run by sh: submits an array, then a merge that waits for it.
set -e
array=$(sbatch --parsable --array=0-@LAST@%@MOST@ --requeue --wrap @JOB@)
sbatch --dependency="afterany:$array" --wrap @MERGEJOB@
)"},
    {"mpi", R"(#!/bin/sh
# Needs OpenMPI's mpirun; burnish itself uses no MPI. A rank that fails does not end the others: the merge finds what is missing.
mpirun -n @SHARDS@ --mca orte_abort_on_non_zero_status 0 @COMMAND@ --shard auto --work @WORK@ || true
@MERGE@
)"},
    {"parallel", R"(#!/bin/sh
# Needs GNU parallel. Run again, it goes on with the pieces that are missing.
set -e
mkdir -p @WORK@
@COMMAND@ --pieces --work @WORK@ | cut -d ' ' -f 3- > @WORK@/commands
parallel --jobs @MOST@ --retries 2 --joblog @WORK@/joblog < @WORK@/commands || true
@MERGE@
)"},
    {"k8s", R"(# Put in the image that holds burnish and the scene, and the claim of a volume that all pods can write.
apiVersion: batch/v1
kind: Job
metadata:
  name: burnish-pieces
spec:
  completionMode: Indexed
  completions: @SHARDS@
  parallelism: @MOST@
  backoffLimit: @SHARDS@
  template:
    spec:
      restartPolicy: Never
      containers:
        - name: burnish
          image: IMAGE
          workingDir: /job
          command: ["sh", "-c", @SHARDJSON@]
          volumeMounts: [{name: job, mountPath: /job}]
      volumes: [{name: job, persistentVolumeClaim: {claimName: CLAIM}}]
# When this job is complete, run in the same folder: @MERGE@
)"},
    {"openjd", R"(specificationVersion: jobtemplate-2023-09
name: burnish pieces
steps:
  - name: pieces
    parameterSpace:
      taskParameterDefinitions:
        - {name: Share, type: INT, range: "1-@SHARDS@"}
    script:
      actions:
        onRun:
          command: burnish
          args: @ARGS@
  - name: merge
    dependencies: [{dependsOn: pieces}]
    script:
      actions:
        onRun:
          command: sh
          args: ["-c", @MERGEJSON@]
)"},
    {"github", R"(jobs:
  pieces:
    runs-on: ubuntu-latest
    strategy:
      fail-fast: false
      max-parallel: @MOST@
      matrix:
        share: [@SHARES@]
    steps:
      - uses: actions/checkout@v4
      # Install burnish here.
      - run: @COMMAND@ --shard ${{ matrix.share }}/@SHARDS@ --work @WORK@
      - uses: actions/upload-artifact@v4
        with: {name: "pieces-${{ matrix.share }}", path: @WORK@}
  merge:
    needs: pieces
    if: always()
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v4
      # Install burnish here.
      - uses: actions/download-artifact@v4
        with: {pattern: "pieces-*", path: @WORK@, merge-multiple: true}
      - run: @MERGE@
)"}};

std::string replaced(std::string text, const std::string& place, const std::string& by)
{
    for (std::size_t at = text.find(place); at != std::string::npos; at = text.find(place, at + by.size()))
        text.replace(at, place.size(), by);
    return text;
}

std::string json(const nlohmann::json& value)
{
    return value.dump();
}

} // namespace

std::vector<std::string> submit_engines()
{
    std::vector<std::string> names;
    std::transform(std::begin(kScripts), std::end(kScripts), std::back_inserter(names),
                   [](const Script& e) { return std::string(e.name); });
    return names;
}

std::string submit_script(const SubmitOptions& options)
{
    const auto engine = std::find_if(std::begin(kScripts), std::end(kScripts), [&](const Script& e) { return options.engine == e.name; });
    const std::string shards = std::to_string(options.shards), work = shell_words({options.work});
    const std::string command = "burnish " + shell_words(options.words);
    const std::string merge = "burnish merge " + work + " > /dev/null || { burnish merge " + work + " | sh; burnish merge " + work + "; }";
    std::vector<std::string> args = options.words;
    args.insert(args.end(), {"--shard", "{{Task.Param.Share}}/" + shards, "--work", options.work});
    std::string shares;
    for (int i = 1; i <= options.shards; ++i)
        shares += (i > 1 ? ", " : "") + std::to_string(i);
    std::string text = engine->text;
    const std::pair<const char*, std::string> places[] = {{"@COMMAND@", command},
                                                          {"@JOB@", shell_words({command + " --take --work " + work})},
                                                          {"@SHARDJSON@", json(command + " --shard auto/" + shards + " --work " + work)},
                                                          {"@MERGEJOB@", shell_words({merge})},
                                                          {"@MERGEJSON@", json(merge)},
                                                          {"@MERGE@", merge},
                                                          {"@ARGS@", json(args)},
                                                          {"@WORK@", work},
                                                          {"@SHARDS@", shards},
                                                          {"@SHARES@", shares},
                                                          {"@LAST@", std::to_string(options.shards - 1)},
                                                          {"@MOST@", std::to_string(options.at_once ? options.at_once : options.shards)}};
    for (const auto& [place, by] : places)
        text = replaced(text, place, by);
    return text;
}

} // namespace burnish
