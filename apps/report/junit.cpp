#include "apps/report/junit.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/report/html.h"

namespace burnish {

std::string junit_text(const std::string& suite, const std::string& area, const std::vector<JunitCase>& cases)
{
    using Outcome = JunitCase::Outcome;
    const auto count = [&cases](Outcome outcome) {
        return std::count_if(cases.begin(), cases.end(), [outcome](const JunitCase& c) { return c.outcome == outcome; });
    };
    std::string rows;
    for (const JunitCase& c : cases) {
        rows += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escaped(area), escaped(without_controls(c.name)));
        rows += c.outcome == Outcome::passed
                    ? "/>\n"
                    : fmt::format("><{} message=\"{}\"/></testcase>\n", c.outcome == Outcome::error ? "error" : "failure",
                                  escaped(without_controls(c.reason)));
    }
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
                       "errors=\"{}\">\n{}</testsuite>\n",
                       escaped(suite), cases.size(), count(Outcome::failure), count(Outcome::error), rows);
}

} // namespace burnish
