#include "apps/cli/report.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/core.h>
#include <string_view>

#include "apps/cli/field_options.h"
#include "core/base/text.h"

namespace burnish {
namespace {

// Returns lines in which GitHub finds no command: none begins with "::", after blanks of any alphabet too, and none holds "##[".
std::string without_commands(std::string lines)
{
    if (!on_github())
        return lines;
    const auto may_be_blank = [](char c) { return c == ' ' || static_cast<unsigned char>(c) >= 128; };
    for (std::size_t at = lines.find("::"); at != std::string::npos; at = lines.find("::", at + 2)) {
        std::size_t before = at;
        while (before > 0 && may_be_blank(lines[before - 1]))
            --before;
        if (before == 0 || lines[before - 1] == '\n')
            lines.insert(at++, 1, '\\');
    }
    for (std::size_t at = lines.find("##["); at != std::string::npos; at = lines.find("##[", at))
        lines.insert(at + 1, 1, '\\');
    return lines;
}

void print_line(const std::string& line)
{
    std::fputs((without_commands(printable(line)) + "\n").c_str(), stderr);
}

} // namespace

bool on_github()
{
    const char* actions = std::getenv("GITHUB_ACTIONS");
    return actions && std::string_view(actions) == "true";
}

int fail(const Error& error)
{
    print_line("burnish: " + line_of(error));
    return static_cast<int>(error.code);
}

Error usage_error(const std::string& place, const std::string& reason)
{
    return Error{ExitCode::usage, "", place, reason};
}

std::string counted(std::uint64_t count, const std::string& noun)
{
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string join(const std::vector<std::string>& names)
{
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

void Report::event(const std::string& label, const std::string& text)
{
    if (!quiet_)
        say(fmt::format("{:<11} {}", label, text));
}

void Report::detail(const std::string& label, const std::string& text)
{
    if (verbosity_ > 0)
        event(label, text);
}

void Report::warning(const std::string& text)
{
    warnings_.push_back(with_options(text));
    if (!quiet_)
        say("burnish: warning: " + warnings_.back());
}

void Report::wrote(const std::string& path)
{
    if (path != "-")
        event("wrote", path);
}

void Report::figures(const std::string& lines)
{
    if (!quiet_)
        asked_for(lines);
}

void Report::asked_for(const std::string& lines)
{
    std::fputs(without_commands(printable_lines(lines)).c_str(), stdout_promised_ ? stderr : stdout);
}

void Report::commands(const std::string& lines)
{
    std::fputs(printable_lines(lines).c_str(), stdout_promised_ ? stderr : stdout);
}

void Report::figure(const std::string& label, const std::string& text)
{
    figures(fmt::format("{:<11} {}\n", label, text));
}

void Report::promise_stdout(const std::vector<std::string>& files)
{
    stdout_promised_ = std::find(files.begin(), files.end(), "-") != files.end();
}

void Report::release()
{
    released_ = true;
    for (const std::string& line : held_)
        print_line(line);
    held_.clear();
}

void Report::say(std::string line)
{
    if (released_)
        print_line(line);
    else
        held_.push_back(std::move(line));
}

} // namespace burnish
