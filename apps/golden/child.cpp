#include "apps/golden/child.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "core/base/file.h"
#include "core/base/text.h"

extern char** environ;

namespace burnish {
namespace {

Error failed(std::string reason)
{
    return Error{ExitCode::bad_input, "", "", std::move(reason)};
}

// Returns the environment's lines, with `changes` in place of variables with these names.
std::vector<std::string> environment_with(const std::map<std::string, std::string>& changes)
{
    std::vector<std::string> lines;
    for (char** at = environ; *at; ++at) {
        const std::string line = *at;
        if (!changes.contains(line.substr(0, line.find('='))))
            lines.push_back(line);
    }
    for (const auto& [name, value] : changes)
        lines.push_back(name + "=" + value);
    return lines;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts)
{
    std::vector<char*> pointers;
    for (std::string& text : texts)
        pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

// Returns ": LINE" with the last line of a program's output, or "".
std::string last_words(const std::string& path)
{
    constexpr std::uint64_t kMostBytes = 64ull << 20;
    constexpr std::size_t kMostCharacters = 200;
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, kMostBytes);
    if (!bytes)
        return "";
    const std::string text(bytes->begin(), bytes->end());
    const std::size_t end = text.find_last_not_of(" \r\n\t");
    if (end == std::string::npos)
        return "";
    const std::size_t before = text.rfind('\n', end);
    const std::string line = text.substr(before == std::string::npos ? 0 : before + 1, kMostCharacters);
    return ": " + printable(line.substr(0, line.find_first_of("\r\n")));
}

// Waits for the child's end, or kills its group at the limit or when stopped. Returns false then.
bool wait_for(pid_t child, double seconds, const std::atomic<bool>* stop, int& status)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    for (auto pause = std::chrono::milliseconds(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended < 0 && errno != EINTR)
            status = -1; // its end is not known
        if (ended == child || (ended < 0 && errno != EINTR))
            return true;
        if (Clock::now() >= end || (stop && *stop))
            break;
        std::this_thread::sleep_for(pause);
    }
    kill(-child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return false;
}

} // namespace

Status run_child(const ChildRun& run)
{
    std::vector<std::string> words = run.words, variables = environment_with(run.environment);
    const std::vector<char*> arguments = pointers_to(words), environment = pointers_to(variables);
    // Print into the file, in a process group of its own
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, run.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, run.folder.c_str());
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    pid_t child = 0;
    const int error = posix_spawnp(&child, arguments[0], &actions, &attributes, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        return failed(fmt::format("{} cannot be started: {}", run.words[0], std::strerror(error)));
    int status = 0;
    if (!wait_for(child, run.seconds, run.stop, status))
        return failed(run.stop && *run.stop ? run.words[0] + " was stopped"
                                            : fmt::format("{} was stopped after {:g} s", run.words[0], run.seconds));
    kill(-child, SIGKILL); // whatever it left running
    if (status == -1)
        return failed(fmt::format("{} ended, and nobody knows how", run.words[0]));
    if (WIFSIGNALED(status))
        return failed(fmt::format("{} was ended by signal {}", run.words[0], WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0)
        return failed(fmt::format("{} ended with exit code {}{}", run.words[0], WEXITSTATUS(status), last_words(run.output)));
    return {};
}

} // namespace burnish
