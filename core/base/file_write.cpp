#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
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
constexpr int kNameTries = 16; // random 64-bit names do not collide; a folder where each one exists is broken

Error unwritable(const std::string& path, int code)
{
    const std::string reason = code == ENOENT ? "its folder does not exist" : std::generic_category().message(code);
    return {ExitCode::output_failed, path, "", "cannot be written: " + reason};
}

// Returns 0, or the errno of the first failure.
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

bool cannot_sync(int code) // pipes, devices, and file systems without anything to sync
{
    return code == EINVAL || code == EROFS || code == ENOTSUP;
}

using Write = std::function<void(const PutBytes& put)>;

// Writes the bytes and flushes them to disk: a full disk may show itself only at the flush.
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

// Flushes a folder: a new name is on disk only once its folder is.
int sync_folder(const fs::path& folder)
{
    const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd) // a folder may be writable but not readable
        return 0;
    return ::fsync(fd.get()) == 0 || cannot_sync(errno) ? 0 : errno;
}

std::string random_digits()
{
    std::uint64_t value = 0;
    if (::getentropy(&value, sizeof(value)) != 0)
        value = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()) ^
                static_cast<std::uint64_t>(::getpid()) << 40;
    char text[kHexDigits + 1];
    std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(value));
    return text;
}

// Returns the common start of a file's temporary names. Names hold at most 255 bytes.
std::string stem_of(const fs::path& target)
{
    return target.filename().string().substr(0, 200);
}

std::string temporary_beside(const fs::path& target)
{
    std::string name = stem_of(target); // inserts into the name, because GCC 12 warns of "." + name
    return (target.parent_path() / name.insert(0, 1, '.').append(".").append(random_digits()).append(kEnding)).string();
}

// Locks a file and returns true on success. Each writer locks its temporary file, so an unlocked one is a leftover. A
// file system without locks fails with ENOLCK or the like; nothing counts as a leftover there.
bool lock(int fd)
{
    return ::flock(fd, LOCK_EX | LOCK_NB) == 0;
}

// A file being written: its descriptor, and its temporary name if it has one.
struct Temporary {
    Descriptor file;
    std::string name;
};

// Makes an unnamed file: a killed process leaves nothing behind.
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
        // Another process may have removed the file as a leftover before the lock.
        if ((lock(made.file.get()) || errno != EWOULDBLOCK) && ::fstat(made.file.get(), &info) == 0 && info.st_nlink > 0)
            return 0;
    }
    return EEXIST;
}

// Gives an unnamed file a temporary name. Then rename() can replace an existing file, which linkat() cannot.
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

// Gives the new file the owner and permissions of the file that it replaces.
void keep_owner(int fd, const struct stat& before)
{
    const mode_t mode = before.st_mode & 0777;
    const bool owned = ::fchown(fd, before.st_uid, before.st_gid) == 0;
    if (!owned && before.st_gid != ::getegid()) // the old group's permissions are not for another group
        static_cast<void>(::fchmod(fd, mode & 0707));
    else
        static_cast<void>(::fchmod(fd, mode));
}

// Follows links to their target, which need not exist. Returns 0, or the errno of the obstacle.
int follow_links(fs::path& target)
{
    struct stat info {};
    std::error_code failed;
    if (::stat(target.c_str(), &info) == 0) {
        if (fs::is_symlink(target, failed) && S_ISREG(info.st_mode)) // pipes behind /proc/self/fd have no path
            if (fs::path whole = fs::canonical(target, failed); !failed)
                target = std::move(whole);
        return 0;
    }
    if (errno != ENOENT) // a name too long, circular links, a file in place of a folder
        return errno;
    constexpr int kMostLinks = 40; // the limit in Linux
    for (int i = 0; i < kMostLinks; ++i) {
        if (::lstat(target.c_str(), &info) != 0)
            return errno == ENOENT ? 0 : errno;
        const fs::path next = S_ISLNK(info.st_mode) ? fs::read_symlink(target, failed) : fs::path();
        if (next.empty())
            return 0;
        target = next.is_absolute() ? next : folder_of(target) / next;
    }
    return ELOOP;
}

using Maker = int (*)(const fs::path& target, mode_t mode, Temporary& made);

// Writes a temporary file and renames it to `target`. `before` is the existing file, whose owner and permissions stay,
// or null.
int write_by(Maker make, const fs::path& target, const struct stat* before, const Write& write)
{
    Temporary temporary;
    const mode_t mode = before ? before->st_mode & 0777 : 0666;
    if (const int code = make(target, mode, temporary))
        return code;
    const int fd = temporary.file.get();
    if (before)
        keep_owner(fd, *before);
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

// Raises the number of open files to the hard limit. Returns false where it is there already.
bool allow_more_files()
{
    struct rlimit files {};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= files.rlim_max)
        return false;
    files.rlim_cur = files.rlim_max;
    return ::setrlimit(RLIMIT_NOFILE, &files) == 0;
}

// Makes a file without a name, or else with a temporary one. Returns 0, or the errno of the obstacle.
int make_some(const fs::path& target, Temporary& made)
{
    const bool has_names = ::access("/proc/self/fd", X_OK) == 0; // /proc/self/fd is how an unnamed file gets its name
    int code = has_names ? make_unnamed(target, 0666, made) : EOPNOTSUPP;
    if (code == EMFILE && allow_more_files())
        code = make_unnamed(target, 0666, made);
    if (code != 0 && code != EMFILE && code != ENOENT && code != EACCES)
        code = make_named(target, 0666, made);
    return code;
}

// Makes a folder with a temporary name beside `target`, and locks it against removal as a leftover.
int make_locked_folder(const fs::path& target, std::string& name, Descriptor& held)
{
    for (int i = 0; i < kNameTries; ++i) {
        name = temporary_beside(target);
        if (::mkdir(name.c_str(), 0777) != 0 && errno != EEXIST)
            return errno;
        held.reset(::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        struct stat info {};
        // Another process may have removed the folder as a leftover before the lock.
        if (held && (lock(held.get()) || errno != EWOULDBLOCK) && ::fstat(held.get(), &info) == 0 && info.st_nlink > 0)
            return 0;
    }
    return EEXIST;
}

// Renames a folder. Fails with EEXIST where the new name is taken.
int rename_to_new(const std::string& from, const std::string& to)
{
#ifndef __EMSCRIPTEN__
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && errno != ENOSYS)
        return -1;
#endif
    const int code = ::rename(from.c_str(), to.c_str()); // rename() replaces only an empty folder
    if (code != 0 && errno == ENOTEMPTY)
        errno = EEXIST;
    return code;
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

std::string written_place(const std::string& path)
{
    fs::path target(path);
    return follow_links(target) == 0 ? target.string() : path;
}

FileSet::FileSet(const std::string& folder) : folder_(folder)
{
    while (folder_.size() > 1 && folder_.back() == '/')
        folder_.pop_back();
    std::error_code failed;
    is_new_ = !fs::exists(folder_, failed);
    if (is_new_)
        fs::create_directories(folder_of(folder_), failed); // add() reports the error
    sweep(folder_);
}

FileSet::~FileSet()
{
    for (const Added& file : added_)
        if (!file.temporary.empty())
            ::unlink(file.temporary.c_str());
}

Status FileSet::add(const std::string& name, const void* data, std::size_t size)
{
    // Find the file to write or replace
    const std::string path = (fs::path(folder_) / name).string();
    fs::path target = is_new_ ? folder_ : path; // files for a new folder lie beside it
    struct stat before {};
    if (const int code = is_new_ ? 0 : follow_links(target))
        return unwritable(path, code);
    const bool exists = !is_new_ && ::lstat(target.c_str(), &before) == 0;
    if (exists && !S_ISREG(before.st_mode))
        return unwritable(path, S_ISDIR(before.st_mode) ? EISDIR : EEXIST);
    if (!is_new_)
        sweep(target);
    // Make a file without a name, or else with a temporary one
    Temporary made;
    if (const int code = make_some(target, made))
        return unwritable(path, code);
    // Keep an existing file's permissions, and write the bytes
    if (exists)
        keep_owner(made.file.get(), before);
    added_.push_back({std::move(made.file), made.name, name, is_new_ ? "" : target.string()});
    const int code = write_and_sync(added_.back().file.get(), [&](const PutBytes& put) { put(data, size); });
    return code ? Status(unwritable(path, code)) : Status();
}

// Names a file `place`, where no file exists. The file may be unnamed or have a temporary name.
int FileSet::give_name(Added& file, const std::string& place)
{
    const std::string self = "/proc/self/fd/" + std::to_string(file.file.get());
    const bool named = file.temporary.empty() ? ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, place.c_str(), AT_SYMLINK_FOLLOW) == 0
                                              : ::rename(file.temporary.c_str(), place.c_str()) == 0;
    if (!named)
        return errno;
    file.temporary = place;
    return 0;
}

// Fills a folder under a temporary name and renames the folder: it appears with all files, or not at all. Where another
// process has made the folder first, the files go into that folder.
int FileSet::name_in_new_folder()
{
    std::string staged;
    Descriptor held;
    if (const int code = make_locked_folder(folder_, staged, held))
        return code;
    // Fill the folder under its temporary name
    int code = 0;
    for (std::size_t i = 0; i < added_.size() && code == 0; ++i)
        code = give_name(added_[i], (fs::path(staged) / added_[i].name).string());
    if (code == 0)
        code = sync_folder(staged);
    // Give the folder its name
    if (code == 0 && rename_to_new(staged, folder_) == 0) {
        added_.clear();
        return sync_folder(folder_of(folder_));
    }
    // Where the folder exists by now, move the files into it
    code = code ? code : errno;
    for (std::size_t i = 0; i < added_.size() && code == EEXIST; ++i) {
        const std::string place = (fs::path(folder_) / added_[i].name).string();
        if (::rename(added_[i].temporary.c_str(), place.c_str()) != 0)
            code = errno;
        else
            added_[i].temporary.clear();
    }
    // Remove the leftovers
    for (Added& file : added_)
        if (!file.temporary.empty())
            ::unlink(file.temporary.c_str()), file.temporary.clear();
    ::rmdir(staged.c_str());
    added_.clear();
    return code == EEXIST ? sync_folder(folder_) : code;
}

Status FileSet::name_all()
{
    if (is_new_) {
        const int code = name_in_new_folder();
        return code ? Status(unwritable(folder_, code)) : Status();
    }
    std::string last;
    while (!added_.empty()) {
        Added& file = added_.back();
        last = file.target;
        int code = file.temporary.empty() ? give_name(file, temporary_beside(file.target)) : 0;
        if (code == 0 && ::rename(file.temporary.c_str(), file.target.c_str()) != 0)
            code = errno;
        if (code != 0)
            return unwritable((fs::path(folder_) / file.name).string(), code);
        file.temporary.clear();
        added_.pop_back();
        const bool other = added_.empty() || folder_of(added_.back().target) != folder_of(last);
        if (const int synced = other ? sync_folder(folder_of(last)) : 0)
            return unwritable(last, synced);
    }
    return {};
}

StreamedFile::StreamedFile(Descriptor file, std::string path, std::string temporary, std::string target)
    : file_(std::move(file)), path_(std::move(path)), temporary_(std::move(temporary)), target_(std::move(target))
{
}

StreamedFile::~StreamedFile()
{
    if (file_ && !temporary_.empty())
        ::unlink(temporary_.c_str());
}

Result<StreamedFile> StreamedFile::make(const std::string& path)
{
    fs::path target(path);
    if (const int code = follow_links(target))
        return unwritable(path, code);
    struct stat before {};
    const bool exists = ::stat(target.c_str(), &before) == 0;
    if (exists && S_ISDIR(before.st_mode))
        return unwritable(path, EISDIR);
    if (exists && !S_ISREG(before.st_mode))
        return Error{ExitCode::output_failed, path, "", "is no plain file: pictures are written there whole, not in bands"};
    sweep(target);
    Temporary made;
    if (const int code = make_some(target, made))
        return unwritable(path, code);
    if (exists)
        keep_owner(made.file.get(), before);
    return StreamedFile(std::move(made.file), path, made.name, target.string());
}

Status StreamedFile::put(const void* data, std::size_t size)
{
    const int code = write_all(file_.get(), data, size);
    return code ? Status(unwritable(path_, code)) : Status();
}

std::string StreamedFile::place() const
{
    return temporary_.empty() ? "/proc/self/fd/" + std::to_string(file_.get()) : temporary_;
}

Status StreamedFile::name_it()
{
    Temporary made{std::move(file_), temporary_};
    int code = ::fsync(made.file.get()) == 0 || cannot_sync(errno) ? 0 : errno;
    if (code == 0 && made.name.empty())
        code = burnish::name_it(made, target_);
    if (code == 0 && ::rename(made.name.c_str(), target_.c_str()) != 0)
        code = errno;
    if (code == 0)
        code = sync_folder(folder_of(target_));
    else if (!made.name.empty())
        ::unlink(made.name.c_str());
    return code ? Status(unwritable(path_, code)) : Status();
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
    if (!file || ::fstat(file.get(), &info) != 0 || !(S_ISREG(info.st_mode) || S_ISDIR(info.st_mode)) || !lock(file.get()))
        return false;
    if (S_ISREG(info.st_mode))
        return ::unlink(path.c_str()) == 0;
    std::error_code failed;
    for (fs::directory_iterator at(path, failed), end; !failed && at != end; at.increment(failed))
        ::unlink(at->path().c_str());
    return ::rmdir(path.c_str()) == 0;
}

Status write_file_atomic(const std::string& path, const void* data, std::size_t size, Links links)
{
    return write_file_atomic(
        path, [&](const PutBytes& put) { put(data, size); }, links);
}

Status write_file_atomic(const std::string& path, const Write& write, Links links)
{
    fs::path target(path);
    if (const int code = links == Links::follow ? follow_links(target) : 0)
        return unwritable(path, code);
    struct stat before {};
    const bool exists = (links == Links::follow ? ::stat(target.c_str(), &before) : ::lstat(target.c_str(), &before)) == 0;
    if (!exists && errno != ENOENT) // a name too long, circular links, a file in place of a folder
        return unwritable(path, errno);
    if (exists && S_ISDIR(before.st_mode))
        return unwritable(path, EISDIR);
    const bool regular = exists && S_ISREG(before.st_mode);
    if (links == Links::follow && exists && !regular) {
        const int code = write_device(target, write);
        return code ? Status(unwritable(path, code)) : Status();
    }
    sweep(target);
    // Try an unnamed file first. File systems and containers without support (no O_TMPFILE, no /proc) fail before or
    // after the write. A second try is useless where the disk is full or broken.
    int code = write_by(make_unnamed, target, regular ? &before : nullptr, write);
    if (code != 0 && code != ENOSPC && code != EDQUOT && code != EFBIG && code != EIO)
        code = write_by(make_named, target, regular ? &before : nullptr, write);
    return code ? Status(unwritable(path, code)) : Status();
}

} // namespace burnish
