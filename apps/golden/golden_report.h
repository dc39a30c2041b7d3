// The files of a run of goldens: JSON Lines, JUnit, a summary in Markdown, GitHub annotations and a page. The same results give the same
// bytes, whatever shares they were made in.
#pragma once
#include <string>
#include <vector>

#include "apps/golden/check.h"
#include "core/base/result.h"

namespace burnish {

struct GoldenCounts {
    std::size_t passed = 0, differs = 0, missing = 0, failed = 0, not_finite = 0; // failed: others than those with NaN or Inf
};
GoldenCounts count_of(const std::vector<GoldenResult>& results);
std::string counts_in_words(const GoldenCounts& counts); // "3 passed, 0 differ, ..."
int exit_code_of(const GoldenCounts& counts);            // bad_input where a picture was not made, else not_finite, differ, golden_missing

bool can_bless(const GoldenResult& result); // a new golden would change the picture's verdict

std::string results_text(const std::vector<GoldenResult>& results); // an object a line
// Reads results.jsonl of a results' folder. Errors: ExitCode::bad_input with the line, also for a path that leaves the folder.
Result<std::vector<GoldenResult>> read_results(const std::string& folder);
// Reads results_text(). path: for errors, the text's file.
Result<std::vector<GoldenResult>> results_of_text(const std::string& text, const std::string& path);

std::string golden_junit(const std::vector<GoldenResult>& results);
std::string golden_summary(const std::vector<GoldenResult>& results);     // Markdown, for a step's page
std::string golden_annotations(const std::vector<GoldenResult>& results); // "::error ...", a line a row that did not pass

// Returns the page. Pictures are in the results' folder; small ones are within the page.
// live: scripts of a page with the renderer inside, by the rows' names; or "".
Result<std::string> golden_page(const std::vector<GoldenResult>& results, const std::string& folder, const std::string& live = "");

// Writes all files into the folder: results.jsonl, junit.xml, summary.md, index.html.
Status write_reports(const std::vector<GoldenResult>& results, const std::string& folder, const std::string& live = "");

} // namespace burnish
