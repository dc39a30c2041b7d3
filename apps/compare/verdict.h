// Verdicts on pictures by the limits of `burnish compare`, and their words in reports.
#pragma once
#include <string>
#include <vector>

#include "apps/compare/figures.h"
#include "apps/report/junit.h"

namespace burnish {

// Returns an Error with ExitCode::not_finite for NaN and Inf, or with ExitCode::differ for the first limit exceeded.
Status judge_pictures(const CompareOptions& options, const CompareFigures& figures, const Pictures& pictures);

// Returns {reference, test, verdict, reason, limits}. verdict: passed, differs or failed; null where no limit is given and nothing fails.
Json verdict_json(const CompareOptions& options, const Status& verdict);
JunitCase verdict_case(const std::string& name, const Status& verdict);
// Returns a page without pictures: the comparison failed, the file at fault, and why.
std::string failure_page(const CompareOptions& options, const Error& error);
// Writes the verdict on pictures that cannot be read or compared, without figures, and prints the error. Returns the exit code.
int fails_unread(const CompareOptions& options, const Error& error);
std::string compare_junit(const std::vector<JunitCase>& cases);
std::string verdict_html(const CompareOptions& options, const Status& verdict); // a paragraph

} // namespace burnish
