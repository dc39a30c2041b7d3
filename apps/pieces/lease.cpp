#include "apps/pieces/lease.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <unistd.h>

#include "core/base/descriptor.h"
#include "core/base/file.h"

namespace burnish {
namespace {

// Returns this machine's name without blanks, and its space of process numbers: containers of one machine have their own.
std::string host_name()
{
    char host[256] = {};
    const bool known = ::gethostname(host, sizeof host - 1) == 0 && host[0] != '\0';
    std::string name = known ? host : "unknown";
    std::replace(name.begin(), name.end(), ' ', '-');
    std::error_code failed;
    const std::string numbers = std::filesystem::read_symlink("/proc/self/ns/pid", failed).string();
    return failed ? name : name + "/" + numbers;
}

// Returns true if a lease's owner ran on this machine and runs no more. content: MACHINE PROCESS RANDOM COUNT.
bool owner_ended(const std::string& content)
{
    std::istringstream words(content);
    std::string host;
    long process = 0;
    words >> host >> process;
    return words && host == host_name() && process > 0 && ::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

std::string content_of(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// Makes the file with this content. Returns false where it exists.
Result<bool> make_new(const std::string& file, const std::string& content)
{
    const Descriptor made(::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666));
    if (!made && errno == EEXIST)
        return false;
    if (!made)
        return Error{ExitCode::output_failed, file, "", std::strerror(errno)};
    errno = ENOSPC; // of a short write
    if (::write(made.get(), content.data(), content.size()) == static_cast<ssize_t>(content.size()))
        return true;
    const Error failed = {ExitCode::output_failed, file, "", std::strerror(errno)};
    ::unlink(file.c_str());
    return failed;
}

} // namespace

Lease::Lease(std::string file, std::string owner, LeaseTimes times)
    : file_(std::move(file)), owner_(std::move(owner)), times_(times), thread_([this] { beat(); })
{
}

Lease::~Lease()
{
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    ended_.notify_all();
    thread_.join();
    if (content_of(file_).starts_with(owner_)) // another process may have taken it over
        ::unlink(file_.c_str());
}

void Lease::beat()
{
    std::unique_lock lock(mutex_);
    for (std::uint64_t count = 1; !ended_.wait_for(lock, times_.beat, [this] { return ends_; }); ++count) {
        if (!content_of(file_).starts_with(owner_))
            return;
        const std::string content = fmt::format("{} {}\n", owner_, count);
        static_cast<void>(static_cast<bool>(write_file_atomic(file_, content.data(), content.size()))); // the next beat may succeed
    }
}

std::string new_process_name()
{
    std::random_device random;
    const std::uint64_t number = (static_cast<std::uint64_t>(random()) << 32) | random();
    return fmt::format("{} {} {:016x}", host_name(), ::getpid(), number);
}

Leases::Leases(std::string owner, LeaseTimes times) : owner_(std::move(owner)), times_(times) {}

Result<std::unique_ptr<Lease>> Leases::take(const std::string& file)
{
    for (int tries = 0; tries < 2; ++tries) {
        Result<bool> made = make_new(file, fmt::format("{} 0\n", owner_));
        BN_TRY(made);
        if (*made)
            return std::make_unique<Lease>(file, owner_, times_);
        // Wait for signs of life
        const std::string content = content_of(file);
        const auto now = std::chrono::steady_clock::now();
        const auto seen = seen_.find(file);
        const bool known = seen != seen_.end() && seen->second.content == content;
        if (!owner_ended(content) && (!known || now - seen->second.since < times_.stale)) {
            if (!known)
                seen_[file] = {content, now};
            return std::unique_ptr<Lease>();
        }
        // Remove a dead owner's lease
        seen_.erase(file);
        if (content_of(file) == content)
            ::unlink(file.c_str());
    }
    return std::unique_ptr<Lease>();
}

} // namespace burnish
