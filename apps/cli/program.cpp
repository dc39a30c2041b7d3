#include "apps/cli/program.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fmt/core.h>
#include <iterator>
#include <string>
#include <vector>

#include "apps/cli/command_line.h"
#include "apps/cli/lab.h"
#include "apps/cli/report.h"
#include "apps/cli/suggest.h"
#include "apps/cli/words.h"
#include "core/base/cgroup.h"
#include "core/base/exception.h"
#include "core/base/version.h"
#include "core/jobs/activity.h"
#include "core/jobs/cores.h"
#include "core/jobs/threads.h"
#include "core/scene/builtin/builtin.h"

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

Exit codes: 0 done, 1 results differ, 2 wrong option, 3 sizes do not match, 4 bad input, 5 a reference is missing,
6 NaN or Inf in a picture, 7 output not written, 70 a fault of the program, 77 not available on this machine, 130 or 143 stopped, with all
work kept in a checkpoint.)";

int print_help(const Command* command, const std::vector<Command>& commands)
{
    std::fputs((command ? help_of(*command) : help_of(commands, kFooter)).c_str(), stdout);
    return 0;
}

// Answers a call without words: an error, with the list of subcommands.
int print_help_as_error(const std::vector<Command>& commands)
{
    std::fputs(help_of(commands, kFooter).c_str(), stderr);
    return fail(usage_error("", "a subcommand is required"));
}

int print_version()
{
    std::printf("burnish %s\n", version());
    return 0;
}

int refuse_subcommand(const std::string& word, const std::vector<Command>& commands)
{
    std::vector<std::string> names = {"help"};
    for (const Command& command : commands)
        names.push_back(command.name);
    std::string meant = did_you_mean(word, names);
    if (const std::string scene = builtin_scene_hint(word); meant.empty() && !scene.empty())
        meant = "; " + scene;
    return fail(usage_error("", fmt::format("no subcommand '{}': there are {}{} (see burnish --help)", word, join(names), meant)));
}

// Returns true for builtin:NAME or builtin:NAME=AMOUNT of a scene that burnish-lab alone has.
bool names_lab_scene(const std::string& word)
{
    constexpr const char* const names[] = {
#define BN_LAB_SCENE(name) "builtin:" name,
#include "apps/cli/lab_scenes.def"
    };
    const std::string name = word.substr(0, word.find('='));
    return std::any_of(std::begin(names), std::end(names), [&](const char* known) { return name == known; });
}

int run(const std::vector<std::string>& words)
{
    if (const auto scene = std::find_if(words.begin(), words.end(), names_lab_scene); parametric_scenes().empty() && scene != words.end())
        return start_lab(words, *scene);
    std::vector<Command> commands = all_commands();
    const auto find = [&](const std::string& name) {
        return std::find_if(commands.begin(), commands.end(), [&](const Command& command) { return command.name == name; });
    };
    // Handle the program's own options
    const std::string first = words.empty() ? "" : words[0];
    if (first == "-h" || first == "--help")
        return print_help(nullptr, commands);
    if (first == "--version")
        return print_version();
    if (first.empty())
        return print_help_as_error(commands);
    if (first[0] == '-')
        return fail(usage_error("", "The following argument was not expected: " + first + " (see burnish --help)"));
    if (first == "help") {
        const auto command = words.size() < 2 ? commands.end() : find(words[1]);
        if (words.size() > 1 && command == commands.end())
            return refuse_subcommand(words[1], commands);
        if (command != commands.end() && !command->run)
            return start_lab({words[1], "--help"});
        return print_help(command == commands.end() ? nullptr : &*command, commands);
    }
    // Find the subcommand; a scene alone means `render`
    const auto named = find(first);
    const bool drawn = named == commands.end() && looks_like_scene(first);
    const auto command = drawn ? find("render") : named;
    if (command == commands.end())
        return refuse_subcommand(first, commands);
    if (!command->run)
        return start_lab(words);
    // Answer --help and --version
    const std::vector<std::string> rest(words.begin() + !drawn, words.end());
    switch (asked_by(*command, rest)) {
    case Asked::help:
        return print_help(&*command, commands);
    case Asked::version:
        return print_version();
    case Asked::nothing:
        break;
    }
    // Run the subcommand
    set_command_words(words);
    if (const Status read = read_command_line(*command, rest); !read)
        return fail(read.error());
    Activity::tell(!command->options.given("--quiet"));
    const Activity activity(command->name);
    return command->run(command->options);
}

int flush_stdout(int code)
{
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!lost || code != 0)
        return code;
    return fail(Error{ExitCode::output_failed, "standard output", "", "cannot be written"});
}

// Returns true for --quiet, and for -q alone or behind other flags of one letter.
bool says_quiet(const std::string& word)
{
    const std::size_t at = word.find_first_not_of('v', 1);
    return word == "--quiet" || (word.starts_with('-') && at != std::string::npos && word[at] == 'q');
}

// Warns if fewer threads did the work than were asked for. Prints nothing after an error, so an error stays one line.
void warn_of_missing_threads(int code, const std::vector<std::string>& words)
{
    const std::string missing = missing_threads();
    const bool quiet = std::any_of(words.begin(), words.end(), says_quiet);
    if (code != 0 || missing.empty() || quiet)
        return;
    Report report(false, 0);
    report.warning(missing);
    report.release();
}

// Reports the exception that a catch block handles. Returns the exit code.
int fail_by_exception()
{
    return fail(error_of_exception(Error{ExitCode::internal, "", "", "internal error"}));
}

// Handles exceptions that no frame can catch, such as those thrown while a library is loaded.
[[noreturn]] void terminate()
{
    if (const std::exception_ptr thrown = std::current_exception())
        try {
            std::rethrow_exception(thrown);
        } catch (...) {
            std::_Exit(fail_by_exception());
        }
    std::abort();
}

} // namespace

int run_words(const std::vector<std::string>& words)
{
    return run(words);
}

int run_program(int argc, char** argv)
{
    // Turns a file-size limit into a failed write with a message; the default kills the process.
    std::signal(SIGXFSZ, SIG_IGN);
    std::set_terminate(terminate);
    try {
        bound_memory(usable_cores());
        const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
        const int code = flush_stdout(run(words));
        warn_of_missing_threads(code, words);
        return code;
    } catch (...) {
        return fail_by_exception();
    }
}

} // namespace burnish
