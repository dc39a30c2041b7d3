#include "apps/pieces/submit.h"

#include <algorithm>
#include <cstring>
#include <fmt/core.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "apps/cli/report.h"
#include "apps/pieces/words.h"

namespace burnish {
namespace {

// A script, with places:
//   @COMMAND@                the burnish command as shell words
//   @TAKE@                   the command that takes pieces, as one shell word
//   @TAKEJSON@               the same as JSON
//   @ARGS@                   the command with one share, as a list of words in JSON
//   @WORK@, @WORKJSON@       the folder of the pieces
//   @SHARDS@, @LAST@         the number of shares, and one less
//   @SHARES@                 1, 2, ... with commas
//   @MOST@                   how many run at once
//   @OUTPUTS@                lines with the command's outputs
//   @MERGE@, @MERGEWORD@, @MERGEJSON@  a shell line that merges, makes the missing pieces, and merges again
//   @TAKEMERGE@              a shell line in JSON that takes pieces too, then merges
struct Script {
    const char *name, *text;
    bool limits = true;  // how many run at once
    int most_shards = 0; // 0: any number
};
constexpr Script kScripts[] = {
    {"slurm", R"(#!/bin/sh
# Run by sh: submits an array, then a merge that waits for it.
set -e
array=$(sbatch --parsable --array=0-@LAST@%@MOST@ --requeue --wrap @TAKE@)
sbatch --dependency="afterany:$array" --wrap @MERGEWORD@
)"},
    {"mpi", R"(#!/bin/sh
# Needs OpenMPI's mpirun; burnish itself uses no MPI. A rank that fails or is killed does not end the others: the merge finds what is missing.
mpirun -n @SHARDS@ --enable-recovery --mca orte_abort_on_non_zero_status 0 @COMMAND@ --shard auto --work @WORK@ || true
@MERGE@
)",
     false},
    {"parallel", R"(#!/bin/sh
# Needs GNU parallel. Run again, it goes on with the pieces that are missing.
set -e
mkdir -p @WORK@
@COMMAND@ --pieces --work @WORK@ | cut -d ' ' -f 3- > @WORK@/commands
parallel --jobs @MOST@ --retries 2 --joblog @WORK@/joblog < @WORK@/commands || true
@MERGE@
)"},
    {"k8s",
     R"(# Put in the image that holds burnish, and the claim of a volume with the scene, which all pods can write. The second job takes pieces
# too, and merges when all are there.
apiVersion: batch/v1
kind: Job
metadata:
  name: burnish-pieces
spec:
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
          command: ["sh", "-c", @TAKEJSON@]
          volumeMounts: [{name: job, mountPath: /job}]
      volumes: [{name: job, persistentVolumeClaim: {claimName: CLAIM}}]
---
apiVersion: batch/v1
kind: Job
metadata:
  name: burnish-merge
spec:
  backoffLimit: 4
  podFailurePolicy: # a verdict is no reason to try again
    rules:
      - action: FailJob
        onExitCodes: {containerName: burnish, operator: In, values: [1, 2, 4, 6]}
  template:
    spec:
      restartPolicy: Never
      containers:
        - name: burnish
          image: IMAGE
          workingDir: /job
          command: ["sh", "-c", @TAKEMERGE@]
          volumeMounts: [{name: job, mountPath: /job}]
      volumes: [{name: job, persistentVolumeClaim: {claimName: CLAIM}}]
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
)",
     false},
    {"github", R"(name: burnish pieces
on: workflow_dispatch
jobs:
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
      - run: |
          @COMMAND@ --shard ${{ matrix.share }}/@SHARDS@ --work @WORK@
      - uses: actions/upload-artifact@v4
        with:
          name: pieces-${{ matrix.share }}
          path: @WORKJSON@
  merge:
    needs: pieces
    if: always()
    runs-on: ubuntu-latest
    steps:
      - uses: actions/checkout@v4
      # Install burnish here.
      - uses: actions/download-artifact@v4
        with:
          pattern: pieces-*
          path: @WORKJSON@
          merge-multiple: true
      - run: |
          @MERGE@
      - if: always()
        uses: actions/upload-artifact@v4
        with:
          name: merged
          path: |
@OUTPUTS@)",
     true, 256}};

// Replaces each place of a template once: a place's content is not read again.
template <std::size_t N> std::string filled(const std::string& text, const std::pair<const char*, std::string> (&places)[N])
{
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const auto place = std::find_if(std::begin(places), std::end(places),
                                        [&](const auto& p) { return text.compare(at, std::strlen(p.first), p.first) == 0; });
        if (place == std::end(places)) {
            out += text[at++];
            continue;
        }
        out += place->second;
        at += std::strlen(place->first);
    }
    return out;
}

const Script& script_of(const std::string& engine)
{
    return *std::find_if(std::begin(kScripts), std::end(kScripts), [&](const Script& s) { return engine == s.name; });
}

std::string as_json(const nlohmann::json& value)
{
    return value.dump();
}

// Doubles each $, which Kubernetes takes for the beginning of a variable.
std::string for_kubernetes(const std::string& line)
{
    std::string doubled;
    for (const char c : line)
        doubled += c == '$' ? std::string("$$") : std::string(1, c);
    return as_json(doubled);
}

// Returns the outputs that the command names, as lines of a text in YAML. A number in a name becomes *.
std::string output_lines(const std::vector<std::string>& words)
{
    std::string lines;
    static const std::regex number("%[0-9]*d");
    const auto add = [&](const std::string& path) { lines += "            " + std::regex_replace(path, number, "*") + "\n"; };
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i] == "-o" || words[i] == "--output")
            add(i + 1 < words.size() ? words[i + 1] : "");
        else if (words[i].starts_with("--output=") || (words[i].starts_with("-o") && words[i].size() > 2))
            add(words[i].substr(words[i].starts_with("--") ? std::strlen("--output=") : 2));
    return lines.empty() ? "            .\n" : lines;
}

} // namespace

std::vector<std::string> submit_engines()
{
    std::vector<std::string> names;
    std::transform(std::begin(kScripts), std::end(kScripts), std::back_inserter(names),
                   [](const Script& e) { return std::string(e.name); });
    return names;
}

Status check_submit(const SubmitOptions& options)
{
    const Script& script = script_of(options.engine);
    if (options.at_once && !script.limits)
        return usage_error("--at-once", std::string(script.name) + " runs all at once");
    if (script.most_shards && options.shards > script.most_shards)
        return usage_error("--shards", fmt::format("{} takes at most {}", script.name, script.most_shards));
    const std::string words = shell_words(options.words) + shell_words({options.work});
    if (words.find("{{") != std::string::npos || words.find('\n') != std::string::npos)
        return usage_error("COMMAND", "holds a line break or {{, which a script would read otherwise");
    try {
        static_cast<void>(as_json(options.words)), static_cast<void>(as_json(options.work));
    } catch (const nlohmann::json::type_error&) {
        return usage_error("COMMAND", "holds words that are not UTF-8");
    }
    return {};
}

std::string submit_script(const SubmitOptions& options)
{
    const std::string shards = std::to_string(options.shards), work = shell_words({options.work});
    const std::string command = "burnish " + shell_words(options.words);
    const std::string once = command + " --merge --work " + work;
    // Where pieces are missing, a merge prints their commands alone
    const std::string merge = "left=$(" + once +
                              ") && code=0 || code=$?; case $left in 'burnish '*) printf '%s\\n' \"$left\" | sh || true; " + once +
                              " && code=0 || code=$?;; ?*) printf '%s\\n' \"$left\";; esac; exit $code";
    const std::string take = command + " --take --work " + work;
    std::vector<std::string> args = options.words;
    args.insert(args.end(), {"--shard", "{{Task.Param.Share}}/" + shards, "--work", options.work});
    std::string shares;
    for (int i = 1; i <= options.shards; ++i)
        shares += (i > 1 ? ", " : "") + std::to_string(i);
    const std::pair<const char*, std::string> places[] = {{"@COMMAND@", command},
                                                          {"@TAKEJSON@", for_kubernetes(take)},
                                                          {"@TAKEMERGE@", for_kubernetes(take + " || true; " + merge)},
                                                          {"@TAKE@", shell_words({take})},
                                                          {"@MERGEWORD@", shell_words({merge})},
                                                          {"@MERGEJSON@", as_json(merge)},
                                                          {"@MERGE@", merge},
                                                          {"@OUTPUTS@", output_lines(options.words)},
                                                          {"@ARGS@", as_json(args)},
                                                          {"@WORKJSON@", as_json(options.work)},
                                                          {"@WORK@", work},
                                                          {"@SHARDS@", shards},
                                                          {"@SHARES@", shares},
                                                          {"@LAST@", std::to_string(options.shards - 1)},
                                                          {"@MOST@", std::to_string(options.at_once ? options.at_once : options.shards)}};
    return filled(script_of(options.engine).text, places);
}

} // namespace burnish
