// The `burnish` program: finds the subcommand, runs it, and turns every outcome into one of the exit codes of
// core/base/result.h.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/cli/command_line.h"
#include "apps/cli/report.h"
#include "core/base/cgroup.h"
#include "core/base/version.h"
#include "core/jobs/cores.h"

namespace burnish {
namespace {

constexpr const char* kFooter = R"(Examples:
  burnish render                                     the built-in teapot, figures only
  burnish render lamp.glb --env workshop.hdr -o lamp.png -o lamp.exr
  burnish compare reference.png test.png --html report.html
  burnish chart lamp.glb --env workshop.hdr -o report
  burnish profile lamp.glb --technique major_axis --svg lamp.svg
  burnish list techniques
  burnish info --json

Exit codes: 0 done, 1 results differ, 2 wrong option, 3 sizes do not match, 4 bad input, 6 NaN or Inf in a picture,
7 output not written, 70 a fault of the program, 77 not available on this machine, 130 or 143 stopped, with everything
kept in a checkpoint.)";

int run(const std::vector<std::string>& words)
{
    std::vector<Command> commands;
#define BN_COMMAND(name) commands.push_back(name##_command());
#include "apps/cli/commands.def"
#undef BN_COMMAND

    const std::string first = words.empty() ? "" : words[0];
    if (first == "-h" || first == "--help") {
        std::fputs(help_of(commands, kFooter).c_str(), stdout);
        return 0;
    }
    if (first == "--version") {
        std::printf("burnish %s\n", version());
        return 0;
    }
    if (first.empty())
        return fail(usage_error("", "A subcommand is required (see burnish --help)"));
    if (first[0] == '-')
        return fail(usage_error("", "The following argument was not expected: " + first + " (see burnish --help)"));
    std::vector<std::string> known;
    for (Command& command : commands) {
        known.push_back(command.name);
        if (command.name != first)
            continue;
        const std::vector<std::string> rest(words.begin() + 1, words.end());
        if (asks_for_help(command, rest)) {
            std::fputs(help_of(command).c_str(), stdout);
            return 0;
        }
        if (const Status read = read_command_line(command, rest); !read)
            return fail(read.error());
        return command.run(command.options);
    }
    return fail(usage_error("", "no subcommand '" + first + "': there are " + join(known) + " (see burnish --help)"));
}

int flush_stdout(int code)
{
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!lost || code != 0)
        return code;
    return fail(Error{ExitCode::output_failed, "standard output", "", "cannot be written"});
}

} // namespace
} // namespace burnish

int main(int argc, char** argv)
{
    // A file-size limit shall be a failed write with a message, not the death of the process.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        burnish::bound_memory_by_cgroup(burnish::usable_cores());
        return burnish::flush_stdout(burnish::run(std::vector<std::string>(argv + std::min(argc, 1), argv + argc)));
    } catch (const std::bad_alloc&) {
        return burnish::fail(burnish::Error{burnish::ExitCode::bad_input, "", "", "out of memory"});
    } catch (const std::exception& error) {
        return burnish::fail(burnish::Error{burnish::ExitCode::internal, "", "", std::string("internal error: ") + error.what()});
    }
}
