#include "apps/cli/report.h"

#include <algorithm>
#include <cstdio>
#include <fmt/core.h>

#include "apps/cli/field_options.h"
#include "core/base/text.h"

namespace burnish {
namespace {

void print_line(const std::string& line)
{
    std::fputs((printable(line) + "\n").c_str(), stderr);
}

} // namespace

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
