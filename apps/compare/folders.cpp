#include "apps/compare/folders.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/compare/picture_names.h"
#include "apps/compare/verdict.h"
#include "apps/report/json.h"
#include "core/base/text.h"

namespace burnish {
namespace {

// Returns how grave an exit code is among codes of pictures.
int gravity(int code)
{
    constexpr ExitCode kOrder[] = {ExitCode::differ, ExitCode::not_finite, ExitCode::size_mismatch};
    const auto* found = std::find(std::begin(kOrder), std::end(kOrder), static_cast<ExitCode>(code));
    return code == 0 ? -1 : static_cast<int>(found - std::begin(kOrder));
}

// Returns the verdict on one picture, and puts its figures into the row.
Status compare_one(const CompareOptions& options, const Jobs& jobs, Report& report, Json& row)
{
    const Result<Pictures> pictures = read_pictures(options, jobs);
    BN_TRY(pictures);
    for (const std::string& warning : pictures->warnings)
        report.warning(warning);
    if (!pictures->note.empty())
        report.event("note", pictures->note);
    const CompareFigures figures = compare_pictures(options, *pictures, jobs);
    row = compare_json(options, figures);
    return judge_pictures(options, figures, *pictures);
}

// Returns a picture's figures for people.
std::string line_of(const Json& row)
{
    std::string line;
    for (const auto& [key, name] : {std::pair{"flip_mean", "FLIP"}, {"flip_p99", "p99"}, {"max_abs", "max"}})
        if (const auto value = row.find(key); value != row.end() && value->is_number())
            line += fmt::format("{}{} {:.6f}", line.empty() ? "" : ", ", name, value->get<double>());
    return line;
}

} // namespace

int compare_folders(const CompareOptions& options)
{
    namespace fs = std::filesystem;
    const Result<std::vector<std::string>> names = picture_names(options.reference, options.test);
    if (!names)
        return fail(names.error());
    const Jobs jobs(options.threads);
    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.json, options.csv, options.junit});
    report.release();
    // Compare
    Json rows = Json::array();
    std::vector<JunitCase> cases;
    std::size_t bad = 0;
    int worst = 0;
    for (const std::string& name : *names) {
        CompareOptions one = options;
        one.reference = (fs::path(options.reference) / name).string(), one.test = (fs::path(options.test) / name).string();
        Json figures = Json::object();
        const Status verdict = compare_one(one, jobs, report, figures);
        Json row = {{"name", name}};
        row.update(verdict_json(one, verdict));
        row.update(figures);
        const std::string line = line_of(row);
        report.figure(printable(name), line.empty() ? "cannot be compared" : line);
        rows.push_back(std::move(row));
        cases.push_back(verdict_case(name, verdict));
        if (verdict)
            continue;
        ++bad;
        const int code = fail(verdict.error());
        if (verdict.error().code == ExitCode::usage) // of all pictures
            return code;
        worst = gravity(code) > gravity(worst) ? code : worst;
    }
    report.figure("pictures", bad ? fmt::format("{} of {} fail", bad, names->size()) : fmt::format("{}", names->size()));
    // Write
    const Json json = {{"reference", options.reference}, {"test", options.test}, {"failed", bad}, {"pictures", rows}};
    Status first;
    for (const auto& [path, text] :
         {std::pair{options.json, json_text(json, 2) + "\n"}, {options.csv, csv_text(rows)}, {options.junit, compare_junit(cases)}}) {
        if (path.empty())
            continue;
        const Status status = write_text(path, text);
        if (status)
            report.wrote(path);
        else if (first)
            first = status;
        else
            fail(status.error());
    }
    return first ? worst : fail(first.error());
}

} // namespace burnish
