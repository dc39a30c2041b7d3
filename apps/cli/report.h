// Messages for people: progress on stderr, one line an event; results on stdout, without colour. Machine-readable output goes to stdout
// or
// to files.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// Prints "burnish: FILE: PLACE: REASON" and returns the exit code of the error.
int fail(const Error& error);

// Returns the error for a wrong option, exit code 2. `place` is the option as the user writes it.
Error usage_error(const std::string& place, const std::string& reason);

std::string counted(std::uint64_t count, const std::string& noun); // "1 place", "2 places"

// "a, b, c"
std::string join(const std::vector<std::string>& names);

// Returns true for a step of a workflow on GitHub, which obeys printed lines that begin with "::".
bool on_github();

// Labelled lines, held back until release(). A command with bad input thus prints a single line.
class Report {
  public:
    Report(bool quiet, int verbosity) : quiet_(quiet), verbosity_(verbosity) {}
    void event(const std::string& label, const std::string& text);  // not with --quiet
    void detail(const std::string& label, const std::string& text); // only with -v
    void warning(const std::string& text);                          // "burnish: warning: ...", not with --quiet
    void wrote(const std::string& path);                            // an event, unless the path is standard output
    // Prints results on stdout, or on stderr if stdout is promised to machine-readable output. Not with --quiet.
    void figures(const std::string& lines);
    void asked_for(const std::string& lines);                       // like figures(), also with --quiet: the user asked with "-"
    void commands(const std::string& lines);                        // like asked_for(), for lines that GitHub obeys
    void figure(const std::string& label, const std::string& text); // one line, labelled like an event
    void promise_stdout(const std::vector<std::string>& files);     // if one of `files` is "-"
    void release();
    bool quiet() const { return quiet_; }
    const std::vector<std::string>& warnings() const { return warnings_; } // all of them, also with --quiet

  private:
    void say(std::string line);

    bool quiet_;
    int verbosity_;
    bool released_ = false, stdout_promised_ = false;
    std::vector<std::string> held_, warnings_;
};

} // namespace burnish
