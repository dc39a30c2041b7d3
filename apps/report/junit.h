// Test results in JUnit's XML, which CI systems read.
#pragma once
#include <string>
#include <vector>

namespace burnish {

struct JunitCase {
    enum class Outcome { passed, failure, error }; // error: there is nothing to judge
    std::string name;
    Outcome outcome = Outcome::passed;
    std::string reason;
};

// Returns a document of one suite. `area` is the class of each case. Control characters become blanks.
std::string junit_text(const std::string& suite, const std::string& area, const std::vector<JunitCase>& cases);

} // namespace burnish
