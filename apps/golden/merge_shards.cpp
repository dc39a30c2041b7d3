// Joins the results of shards.
#include <cstdio>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <set>
#include <system_error>

#include "apps/cli/outputs.h"
#include "apps/golden/golden_report.h"
#include "apps/golden/tasks.h"
#include "apps/pieces/words.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path)
{
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

// Returns a line for a shell that makes a shard. words: as words_of_shard() returns them; none: an empty text.
std::string command_of_shard(const std::vector<std::string>& words, std::size_t shard, std::size_t count)
{
    if (words.empty())
        return "";
    std::vector<std::string> all = {
        "burnish", words[0], words[1], "--shard", fmt::format("{}/{}", shard, count), "-o", fmt::format("shard-{}-of-{}", shard, count)};
    all.insert(all.end(), words.begin() + 2, words.end());
    return shell_words(all) + "\n";
}

} // namespace

int merge_golden_shards(const GoldenArguments& arguments, Report& report)
{
    std::vector<GoldenResult> all;
    std::set<std::string> names;
    std::map<std::size_t, std::size_t> shards; // shards found, by the number of all
    std::set<std::size_t> indices;
    std::string manifest;
    std::vector<std::string> words; // of the shards' command
    for (const std::string& folder : arguments.paths) {
        if (same_file(folder, arguments.results))
            return fail(usage_error("-o", "is one of the folders to merge"));
        if (!is_folder(folder)) // of a shard that died
            continue;
        const Result<std::vector<GoldenResult>> results = read_results(folder);
        if (!results)
            return fail(results.error());
        const Result<ResultOrigin> origin = origin_of_results(folder);
        if (!origin)
            return fail(origin.error());
        if (shards.empty())
            manifest = origin->manifest;
        words = words.empty() ? origin->words : words;
        if (origin->manifest != manifest)
            return fail(Error{ExitCode::bad_input, folder, "", "is made from other rows than " + arguments.paths.front()});
        if (!indices.insert(origin->shard.index).second)
            return fail(Error{ExitCode::bad_input, folder, "",
                              fmt::format("is shard {}/{}, as an earlier folder is", origin->shard.index + 1, origin->shard.count)});
        ++shards[origin->shard.count];
        for (const GoldenResult& r : *results) {
            if (!names.insert(r.name).second)
                return fail(Error{ExitCode::bad_input, folder, "", "'" + r.name + "' is in an earlier folder too"});
            all.push_back(r);
        }
    }
    if (shards.empty())
        return fail(Error{ExitCode::bad_input, arguments.paths.front(), "", "is no folder"});
    const std::size_t count = shards.rbegin()->first;
    if (shards.size() != 1)
        return fail(Error{ExitCode::bad_input, arguments.paths.front(), "",
                          fmt::format("{} of {} shards are given", arguments.paths.size(), count)});
    if (indices.size() < count) {
        for (std::size_t i = 0; i < count; ++i)
            if (!indices.contains(i))
                std::fputs(command_of_shard(words, i + 1, count).c_str(), stdout);
        return fail(Error{ExitCode::golden_missing, arguments.paths.front(), "",
                          fmt::format("{} of {} shards are given{}", indices.size(), count,
                                      words.empty() ? "" : "; standard output has the commands of the others")});
    }
    NewResults fresh(arguments.results);
    if (const Status made = fresh.make(arguments.paths, {Share{}, manifest}); !made)
        return fail(made.error());
    for (const std::string& folder : arguments.paths)
        for (const char* name : kResultFolders) {
            if (!is_folder(folder + "/" + name)) // uploads drop empty folders
                continue;
            std::error_code failed;
            fs::copy(folder + "/" + name, fresh.folder() + "/" + name, fs::copy_options::recursive | fs::copy_options::overwrite_existing,
                     failed);
            if (failed)
                return fail(Error{ExitCode::output_failed, folder + "/" + name, "", failed.message()});
        }
    report.release();
    return conclude_golden(std::move(all), nullptr, fresh, arguments, report);
}

} // namespace burnish
