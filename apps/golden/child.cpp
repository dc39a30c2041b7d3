#include "apps/golden/child.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <optional>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "core/base/cgroup.h"
#include "core/base/descriptor.h"
#include "core/base/file.h"
#include "core/base/text.h"

extern char** environ;

namespace burnish {
namespace {

constexpr std::size_t kKeptPart = std::size_t{512} << 10; // bytes of a program's output, at the beginning and at the end
constexpr int kMostLastParts = 32;                        // reads after a program's end: a program that left its group may print for ever

Error failed(std::string reason, ExitCode code = ExitCode::bad_input)
{
    return Error{code, "", "", std::move(reason)};
}
Error not_here(std::string reason) // but elsewhere, perhaps
{
    return failed(std::move(reason), ExitCode::unavailable);
}

bool is_from_outside(int signal)
{
    return signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
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
    constexpr std::uint64_t kMostBytes = 4 * kKeptPart;
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

// Takes a text out of a program's output.
void hide(const std::string& text, const std::string& path)
{
    constexpr std::uint64_t kMostBytes = 4 * kKeptPart;
    const Result<std::vector<std::uint8_t>> bytes = text.empty() ? Error{} : read_file(path, kMostBytes);
    if (!bytes)
        return; // it is empty
    std::string now(bytes->begin(), bytes->end());
    for (std::size_t at = now.find(text); at != now.npos; at = now.find(text, at))
        now.erase(at, text.size());
    if (now.size() < bytes->size())
        static_cast<void>(write_file_atomic(path, now.data(), now.size())); // a full disk keeps the text
}

// The file of a program's output: its first and its last part, and a line that tells how much is left out between.
class Log {
  public:
    explicit Log(const std::string& path) : file_(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {}
    explicit operator bool() const { return static_cast<bool>(file_); }

    void add(const char* bytes, std::size_t count)
    {
        const std::size_t first = std::min(count, kKeptPart - std::min(kKeptPart, written_));
        write_all(bytes, first);
        written_ += first;
        last_.append(bytes + first, count - first);
        if (last_.size() > 2 * kKeptPart)
            drop_to_last_part();
    }

    void end()
    {
        if (last_.size() > kKeptPart)
            drop_to_last_part();
        if (left_out_ > 0) {
            const std::string line = fmt::format("\n... {} bytes are left out here ...\n", left_out_);
            write_all(line.data(), line.size());
        }
        write_all(last_.data(), last_.size());
    }

  private:
    void drop_to_last_part()
    {
        const std::size_t dropped = last_.size() - kKeptPart;
        last_.erase(0, dropped);
        left_out_ += dropped;
    }

    void write_all(const char* bytes, std::size_t count)
    {
        while (count > 0) {
            const ssize_t done = write(file_.get(), bytes, count);
            if (done < 0 && errno == EINTR)
                continue;
            if (done <= 0)
                return; // a full disk loses output, and no picture
            bytes += done, count -= static_cast<std::size_t>(done);
        }
    }

    Descriptor file_;
    std::size_t written_ = 0, left_out_ = 0; // bytes; written_: of the first part
    std::string last_;
};

// Reads a part of the output that is there. Returns false at its end, or where none is there yet.
bool read_part(Descriptor& output, Log& log)
{
    char part[1 << 16];
    const ssize_t count = output ? read(output.get(), part, sizeof part) : -1;
    if (count > 0)
        log.add(part, static_cast<std::size_t>(count));
    if (count == 0)
        output.reset(); // nobody can write any more
    return count > 0;
}

// Keeps the child's output until the child ends. Kills its group at the limit or when stopped, and returns false then.
bool wait_for(pid_t child, pid_t group, double seconds, const std::atomic<bool>* stop, Descriptor& output, Log& log, int& status)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    for (int pause = 1;; pause = std::min(2 * pause, 20)) { // milliseconds
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended < 0 && errno != EINTR)
            status = -1; // its end is not known
        if (ended == child || (ended < 0 && errno != EINTR))
            return true;
        if (Clock::now() >= end || (stop && *stop))
            break;
        pollfd waiting{output.get(), POLLIN, 0}; // poll() passes over a closed one
        if (poll(&waiting, 1, pause) > 0)
            read_part(output, log);
    }
    kill(-group, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return false;
}

// A process group for a program. Its leader waits for this process to end, even by signal 9, and then kills the group. The group exists
// before the program starts, so no signal finds the program without a guard.
class Guard {
  public:
    Guard()
    {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            return; // without a guard the group outlives this process
        const Descriptor watched(ends[0]);
        here_.reset(ends[1]);
        pid_ = fork();
        if (pid_ == 0)
            watch(watched.get());
        if (pid_ > 0)
            setpgid(pid_, pid_); // the guard does the same: one of the two comes first
    }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    ~Guard()
    {
        if (pid_ <= 0)
            return;
        kill(-pid_, SIGKILL); // the guard, and all that the program left running
        while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    pid_t group() const { return std::max(pid_, 0); } // 0: a program starts a group of its own

  private:
    // Calls only what is safe in the child of a process with threads. Leaves the parent's group, which a signal may end as a whole. Closes
    // other descriptors: among them are this pipe's other end, and the ends of other guards.
    [[noreturn]] static void watch(int watched)
    {
        setpgid(0, 0);
        const long most = sysconf(_SC_OPEN_MAX);
        if ((watched > 0 && close_range(0, static_cast<unsigned>(watched) - 1, 0) != 0) ||
            close_range(static_cast<unsigned>(watched) + 1, ~0u, 0) != 0)
            for (int fd = 0; fd < most; ++fd) // a kernel without close_range()
                if (fd != watched)
                    close(fd);
        char byte;
        while (read(watched, &byte, 1) < 0 && errno == EINTR) {
        }
        kill(-getpid(), SIGKILL);
        _exit(0);
    }

    Descriptor here_; // closed by the kernel when this process ends
    pid_t pid_ = -1;
};

} // namespace

Status run_child(const ChildRun& run)
{
    const std::string& name = run.name.empty() ? run.words[0] : run.name;
    std::vector<std::string> words = run.words, variables = environment_with(run.environment);
    const std::vector<char*> arguments = pointers_to(words), environment = pointers_to(variables);
    // Print into a pipe, in a process group of its own
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return not_here(fmt::format("{} cannot be started: {}", name, std::strerror(errno)));
    Descriptor output(ends[0]), input(ends[1]);
    fcntl(output.get(), F_SETFL, O_NONBLOCK);
    Log log(run.output);
    if (!log)
        return not_here(fmt::format("{} cannot be started: {}", run.output, std::strerror(errno)));
    std::optional<Guard> guard(std::in_place);
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, input.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addchdir_np(&actions, run.folder.c_str());
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, guard->group());
    pid_t child = 0;
    const int error = [&] {
        const UnboundMemory unbound;
        return posix_spawnp(&child, arguments[0], &actions, &attributes, arguments.data(), environment.data());
    }();
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
        return not_here(fmt::format("{} cannot be started: {}", name, std::strerror(error)));
    int status = 0;
    input.reset();
    const pid_t group = guard->group() > 0 ? guard->group() : child;
    const bool in_time = wait_for(child, group, run.seconds, run.stop, output, log, status);
    kill(-group, SIGKILL); // whatever it left running
    guard.reset();
    for (int part = 0; part < kMostLastParts && read_part(output, log); ++part) {
    }
    log.end();
    hide(run.hidden, run.output);
    if (!in_time)
        return not_here(run.stop && *run.stop ? name + " was stopped" : fmt::format("{} was stopped after {:g} s", name, run.seconds));
    if (status == -1)
        return failed(fmt::format("{} ended, and nobody knows how", name));
    if (WIFSIGNALED(status))
        return failed(fmt::format("{} was ended by signal {}", name, WTERMSIG(status)),
                      is_from_outside(WTERMSIG(status)) ? ExitCode::unavailable : ExitCode::bad_input);
    if (WEXITSTATUS(status) == 0)
        return {};
    Error ended = failed(fmt::format("{} ended with exit code {}{}", name, WEXITSTATUS(status), last_words(run.output)));
    for (const ExitCode code : {ExitCode::not_finite, ExitCode::output_failed})
        if (WEXITSTATUS(status) == static_cast<int>(code))
            ended.code = code;
    return ended;
}

} // namespace burnish
