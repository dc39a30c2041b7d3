#include "core/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/base/descriptor.h"

namespace burnish {
namespace {

std::string system_reason(int code)
{
    return std::generic_category().message(code);
}

Error unreadable(const std::string& path, const std::string& reason)
{
    return {ExitCode::bad_input, path, "", reason};
}

} // namespace

Result<FileReader> FileReader::open(const std::string& path, std::uint64_t max_bytes, Links links)
{
    // Open without blocking: a pipe without a writer would hang the call.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | (links == Links::refuse ? O_NOFOLLOW : 0)));
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
        return unreadable(path, "has " + std::to_string(size) + " bytes, more than the limit of " + std::to_string(max_bytes));
    return FileReader(std::move(file), path, size);
}

Status FileReader::read(void* to, std::size_t bytes)
{
    for (std::size_t have = 0; have < bytes;) {
        const ssize_t n = ::read(file_.get(), static_cast<std::uint8_t*>(to) + have, bytes - have);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return unreadable(path_, "cannot be read: " + system_reason(errno));
        if (n == 0)
            return unreadable(path_, "became shorter while it was read");
        have += static_cast<std::size_t>(n);
    }
    return {};
}

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes, Links links)
{
    Result<FileReader> file = FileReader::open(path, max_bytes, links);
    BN_TRY(file);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file->size()));
    BN_TRY(file->read(bytes.data(), bytes.size()));
    return bytes;
}

} // namespace burnish
