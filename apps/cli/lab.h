// The laboratory's subcommands and parts of others, in a separate program, burnish-lab, beside this one.
#pragma once
#include <string>
#include <vector>

namespace burnish {

// Replaces this process by burnish-lab with these words. If burnish-lab cannot start, prints a line on standard error and returns
// ExitCode::unavailable. reason: the word that needs it, for this line; empty: the first.
int start_lab(const std::vector<std::string>& words, const std::string& reason = "");
// Starts burnish-lab with the words of set_command_words() (apps/cli/words.h).
int start_lab();

// The part of a subcommand that burnish-lab alone holds. Without it, the call goes to burnish-lab with the same words.
template <class... Arguments> class LabPart {
  public:
    void set(int (*run)(const Arguments&...)) { run_ = run; }
    int operator()(const Arguments&... arguments) const { return run_ ? run_(arguments...) : start_lab(); } // returns the exit code

  private:
    int (*run_)(const Arguments&...) = nullptr;
};

} // namespace burnish
