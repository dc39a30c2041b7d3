#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "core/base/descriptor.h"
#include "core/base/file.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".bntmp";
constexpr std::size_t kHexDigits = 16;
constexpr int kNameTries = 16; // random names of 64 bits do not meet; a folder where each exists is broken otherwise

Error unwritable(const std::string& path, int code)
{
    const std::string reason = code == ENOENT ? "its folder does not exist" : std::generic_category().message(code);
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

bool cannot_sync(int code) // pipes, devices, and file systems that have nothing to do
{
    return code == EINVAL || code == EROFS || code == ENOTSUP;
}

using Write = std::function<void(const PutBytes& put)>;

// Writes and flushes to the disk: a full disk may show itself only then.
int write_and_sync(int fd, const Write& write)
{
    int code = 0;
    write([&](const void* data, std::size_t size) {
        code = code ? code : write_all(fd, data, size);
        return code == 0;
    });
    if (code)
        return code;
    return ::fsync(fd) == 0 || cannot_sync(errno) ? 0 : errno;
}

fs::path folder_of(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// The name itself is on the disk only once its folder is.
int sync_folder(const fs::path& folder)
{
    const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd) // a folder may be writable and not readable
        return 0;
    return ::fsync(fd.get()) == 0 || cannot_sync(errno) ? 0 : errno;
}

std::string random_digits()
{
    std::uint64_t value = 0;
    if (::getrandom(&value, sizeof(value), 0) != static_cast<ssize_t>(sizeof(value)))
        value = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()) ^
                static_cast<std::uint64_t>(::getpid()) << 40;
    char text[kHexDigits + 1];
    std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(value));
    return text;
}

// What a file's temporary names begin with; names hold at most 255 bytes.
std::string stem_of(const fs::path& target)
{
    return target.filename().string().substr(0, 200);
}

std::string temporary_beside(const fs::path& target)
{
    std::string name = stem_of(target); // appended to, as GCC 12 warns of "." + name
    return (target.parent_path() / name.insert(0, 1, '.').append(".").append(random_digits()).append(kEnding)).string();
}

// Whether this process has the file for itself: whoever writes a temporary file holds its lock, so one without is a leftover. File
// systems without locks give ENOLCK or the like, and nothing is taken for a leftover there.
bool lock(int fd)
{
    return ::flock(fd, LOCK_EX | LOCK_NB) == 0;
}

// What is being written: a descriptor, and the temporary name where it has one.
struct Temporary {
    Descriptor file;
    std::string name;
};

// Without a name, so that a process that is killed leaves nothing.
int make_unnamed(const fs::path& target, mode_t mode, Temporary& made)
{
    made.file.reset(::open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode));
    if (!made.file)
        return errno;
    lock(made.file.get());
    return 0;
}

int make_named(const fs::path& target, mode_t mode, Temporary& made)
{
    for (int i = 0; i < kNameTries; ++i) {
        made.name = temporary_beside(target);
        made.file.reset(::open(made.name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode));
        if (!made.file && errno == EEXIST)
            continue;
        if (!made.file)
            return errno;
        struct stat info {};
        // Another process may have taken it for a leftover before it was locked.
        if ((lock(made.file.get()) || errno != EWOULDBLOCK) && ::fstat(made.file.get(), &info) == 0 && info.st_nlink > 0)
            return 0;
    }
    return EEXIST;
}

// Gives an unnamed file a temporary name; rename() can then put it in the place of another, which linkat() cannot.
int name_it(Temporary& temporary, const fs::path& target)
{
    const std::string self = "/proc/self/fd/" + std::to_string(temporary.file.get());
    for (int i = 0; i < kNameTries; ++i) {
        const std::string name = temporary_beside(target);
        if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
            temporary.name = name;
            return 0;
        }
        if (errno != EEXIST)
            return errno;
    }
    return EEXIST;
}

using Maker = int (*)(const fs::path& target, mode_t mode, Temporary& made);

// `before`: the file that is there, whose owner and permissions are kept, or null.
int write_by(Maker make, const fs::path& target, const struct stat* before, const Write& write)
{
    Temporary temporary;
    const mode_t mode = before ? before->st_mode & 0777 : 0666;
    if (const int code = make(target, mode, temporary))
        return code;
    const int fd = temporary.file.get();
    if (before) {
        const bool owned = ::fchown(fd, before->st_uid, before->st_gid) == 0;
        if (!owned && before->st_gid != ::getegid()) // its group's permissions are not for another group
            static_cast<void>(::fchmod(fd, mode & 0707));
        else
            static_cast<void>(::fchmod(fd, mode));
    }
    int code = write_and_sync(fd, write);
    if (code == 0 && temporary.name.empty())
        code = name_it(temporary, target);
    if (code == 0 && ::rename(temporary.name.c_str(), target.c_str()) != 0)
        code = errno;
    if (code == 0)
        return sync_folder(folder_of(target));
    if (!temporary.name.empty())
        ::unlink(temporary.name.c_str());
    return code;
}

bool all_of(const std::string& text, const char* characters)
{
    return !text.empty() && text.find_first_not_of(characters) == std::string::npos;
}

void sweep(const fs::path& target)
{
    std::error_code failed;
    const std::string stem = stem_of(target);
    for (fs::directory_iterator at(folder_of(target), failed), end; !failed && at != end; at.increment(failed))
        if (name_of_temporary(at->path().filename().string()) == stem)
            remove_leftover(at->path().string());
}

int write_device(const fs::path& target, const Write& write)
{
    Descriptor device(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (!device)
        return errno;
    if (const int code = write_and_sync(device.get(), write))
        return code;
    return device.close() == 0 ? 0 : errno;
}

} // namespace

FileSet::~FileSet()
{
    for (const Added& file : added_)
        ::unlink(file.temporary.c_str());
}

Status FileSet::add(const std::string& path, const void* data, std::size_t size)
{
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return unwritable(path, EISDIR);
    sweep(path);
    Temporary temporary;
    int code = make_named(path, 0666, temporary);
    if (code != 0)
        return unwritable(path, code);
    added_.push_back({temporary.name, path});
    if (code = write_and_sync(temporary.file.get(), [&](const PutBytes& put) { put(data, size); });
        code == 0 && temporary.file.close() != 0)
        code = errno;
    return code ? Status(unwritable(path, code)) : Status();
}

Status FileSet::name_all()
{
    while (!added_.empty()) {
        const Added file = added_.back();
        if (::rename(file.temporary.c_str(), file.path.c_str()) != 0)
            return unwritable(file.path, errno);
        added_.pop_back();
        const bool last = added_.empty() || folder_of(added_.back().path) != folder_of(file.path);
        if (const int code = last ? sync_folder(folder_of(file.path)) : 0)
            return unwritable(file.path, code);
    }
    return {};
}

std::string name_of_temporary(const std::string& name)
{
    if (name.size() < 2 || name[0] != '.')
        return "";
    const auto part_before = [&](std::size_t end, std::size_t& begin) { // ".PART" that ends before `end`
        const std::size_t dot = end == 0 ? std::string::npos : name.rfind('.', end - 1);
        begin = dot == std::string::npos ? 0 : dot;
        return begin > 0 ? name.substr(begin + 1, end - begin - 1) : "";
    };
    std::size_t begin = 0;
    if (name.ends_with(kEnding)) {
        const std::string digits = part_before(name.size() - std::string(kEnding).size(), begin);
        return digits.size() == kHexDigits && all_of(digits, "0123456789abcdef") ? name.substr(1, begin - 1) : "";
    }
    constexpr const char* kOldEnding = ".tmp";
    if (!name.ends_with(kOldEnding))
        return "";
    const bool counted = all_of(part_before(name.size() - std::string(kOldEnding).size(), begin), "0123456789");
    const bool pid = counted && all_of(part_before(begin, begin), "0123456789");
    return pid ? name.substr(1, begin - 1) : "";
}

bool remove_leftover(const std::string& path)
{
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat info {};
    return file && ::fstat(file.get(), &info) == 0 && S_ISREG(info.st_mode) && lock(file.get()) && ::unlink(path.c_str()) == 0;
}

Status write_file_atomic(const std::string& path, const void* data, std::size_t size, Links links)
{
    return write_file_atomic(
        path, [&](const PutBytes& put) { put(data, size); }, links);
}

Status write_file_atomic(const std::string& path, const Write& write, Links links)
{
    std::error_code ignored;
    fs::path target(path);
    if (links == Links::follow && fs::is_symlink(target, ignored) && fs::exists(target, ignored))
        target = fs::canonical(target, ignored);
    struct stat before {};
    const bool exists = (links == Links::follow ? ::stat(target.c_str(), &before) : ::lstat(target.c_str(), &before)) == 0;
    if (!exists && errno != ENOENT) // a name too long, a circle of links, a folder that is a file
        return unwritable(path, errno);
    if (exists && S_ISDIR(before.st_mode))
        return unwritable(path, EISDIR);
    const bool regular = exists && S_ISREG(before.st_mode);
    if (links == Links::follow && exists && !regular) {
        const int code = write_device(target, write);
        return code ? Status(unwritable(path, code)) : Status();
    }
    sweep(target);
    // Without a name first; file systems and containers without that (no O_TMPFILE, no /proc) say so before or after the bytes are
    // written, a disk that is full or broken will say it again.
    int code = write_by(make_unnamed, target, regular ? &before : nullptr, write);
    if (code != 0 && code != ENOSPC && code != EDQUOT && code != EFBIG && code != EIO)
        code = write_by(make_named, target, regular ? &before : nullptr, write);
    return code ? Status(unwritable(path, code)) : Status();
}

} // namespace burnish
