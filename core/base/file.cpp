#include "core/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

namespace burnish {
namespace {

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor()
    {
        if (fd_ >= 0)
            ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    int close() // 0, or -1 with errno
    {
        const int fd = fd_;
        fd_ = -1;
        return ::close(fd);
    }

  private:
    int fd_;
};

std::string system_reason(int code)
{
    return std::generic_category().message(code);
}

Error unreadable(const std::string& path, const std::string& reason)
{
    return {ExitCode::bad_input, path, "", reason};
}

Error unwritable(const std::string& path, int code)
{
    const std::string reason = code == ENOENT ? "its folder does not exist" : system_reason(code);
    return {ExitCode::output_failed, path, "", "cannot be written: " + reason};
}

// 0, or the errno of the first failure.
int write_all(int fd, const void* data, std::size_t size)
{
    constexpr std::size_t kLargestWrite = 1u << 30; // Linux writes at most 2 GiB a call
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t n = ::write(fd, at, std::min(size, kLargestWrite));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return errno;
        at += n;
        size -= static_cast<std::size_t>(n);
    }
    return 0;
}

// Writes, flushes to the disk and closes: a full disk may show itself only at the last two.
int write_and_close(Descriptor& file, const void* data, std::size_t size)
{
    if (const int code = write_all(file.get(), data, size))
        return code;
    if (::fsync(file.get()) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP)
        return errno;
    return file.close() == 0 ? 0 : errno;
}

// A name beside `path` that no other process or thread uses.
std::string temporary_beside(const std::filesystem::path& path)
{
    static std::atomic<unsigned> counter{0};
    const std::string stem = path.filename().string().substr(0, 200); // file names hold at most 255 bytes
    const std::string unique =
        "." + stem + "." + std::to_string(::getpid()) + "." + std::to_string(counter++);
    return (path.parent_path() / (unique + ".tmp")).string();
}

} // namespace

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes)
{
    // Non-blocking, so that opening a pipe without a writer does not hang.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0)
        return unreadable(path, "cannot be opened: " + system_reason(errno));
    struct stat info {};
    if (::fstat(file.get(), &info) != 0)
        return unreadable(path, "cannot be examined: " + system_reason(errno));
    if (S_ISDIR(info.st_mode))
        return unreadable(path, "is a folder, not a file");
    if (!S_ISREG(info.st_mode))
        return unreadable(path, "is not a regular file");
    if (info.st_size == 0)
        return unreadable(path, "is empty");
    const std::uint64_t size = static_cast<std::uint64_t>(info.st_size);
    if (size > max_bytes)
        return unreadable(path, "has " + std::to_string(size) + " bytes, more than the limit of " +
                                    std::to_string(max_bytes));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    for (std::size_t have = 0; have < bytes.size();) {
        const ssize_t n = ::read(file.get(), bytes.data() + have, bytes.size() - have);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return unreadable(path, "cannot be read: " + system_reason(errno));
        if (n == 0)
            return unreadable(path, "became shorter while it was read");
        have += static_cast<std::size_t>(n);
    }
    return bytes;
}

Status write_file_atomic(const std::string& path, const void* data, std::size_t size)
{
    namespace fs = std::filesystem;
    std::error_code ignored;
    fs::path target(path);
    if (fs::is_symlink(target, ignored) && fs::exists(target, ignored))
        target = fs::canonical(target, ignored);
    const fs::file_status status = fs::status(target, ignored);
    if (fs::is_directory(status))
        return unwritable(path, EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        Descriptor device(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
        const int code = device.get() < 0 ? errno : write_and_close(device, data, size);
        return code ? Status(unwritable(path, code)) : Status();
    }
    const std::string temporary = temporary_beside(target);
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() < 0)
        return unwritable(path, errno);
    int code = write_and_close(file, data, size);
    if (code == 0 && ::rename(temporary.c_str(), target.c_str()) != 0)
        code = errno;
    if (code == 0)
        return {};
    ::unlink(temporary.c_str());
    return unwritable(path, code);
}

} // namespace burnish
