// The `burnish` program: finds the subcommand, runs it, and turns every outcome into one of the exit codes of
// core/base/result.h.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/command.h"
#include "apps/report.h"
#include "core/base/version.h"

namespace burnish {
namespace {

constexpr int kInternalError = static_cast<int>(ExitCode::internal);

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

// What the user was asking about, for the hint behind a usage error.
std::string help_command(const std::vector<Command>& commands)
{
    for (const Command& command : commands)
        if (command.app->parsed())
            return "burnish " + command.app->get_name() + " --help";
    return "burnish --help";
}

// CLI11 would only say that a subcommand is missing.
Status check_name(const std::vector<Command>& commands, int argc, char** argv)
{
    const std::string name = argc > 1 ? argv[1] : "";
    if (name.empty() || name[0] == '-')
        return {};
    std::vector<std::string> known;
    for (const Command& command : commands)
        known.push_back(command.app->get_name());
    if (std::find(known.begin(), known.end(), name) != known.end())
        return {};
    return usage_error("",
                       "no subcommand '" + name + "': there are " + join(known) + " (see burnish --help)");
}

int run(int argc, char** argv)
{
    CLI::App program("burnish renders anisotropic materials on the CPU.", "burnish");
    program.set_version_flag("--version", std::string("burnish ") + version());
    program.set_help_flag("-h,--help", "Print this text and exit");
    program.get_formatter()->column_width(36);
    program.require_subcommand(1);
    program.footer(kFooter);

    std::vector<Command> commands;
#define BN_COMMAND(name) commands.push_back(add_##name(program));
#include "apps/commands.def"
#undef BN_COMMAND

    if (Status known = check_name(commands, argc, argv); !known)
        return fail(known.error());
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& asked) { // --help, --version
        return program.exit(asked);
    } catch (const CLI::ParseError& wrong) {
        return fail(usage_error("", std::string(wrong.what()) + " (see " + help_command(commands) + ")"));
    }
    for (const Command& command : commands)
        if (command.app->parsed())
            return command.run();
    return kInternalError;
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
        return burnish::flush_stdout(burnish::run(argc, argv));
    } catch (const std::bad_alloc&) {
        return burnish::fail(burnish::Error{burnish::ExitCode::bad_input, "", "", "out of memory"});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "burnish: internal error: %s\n", error.what());
        return burnish::kInternalError;
    }
}
