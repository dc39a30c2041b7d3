#include "core/base/cache.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include "core/base/file.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Returns the variable's value, or "" where the value is not an absolute path. The XDG specification says to ignore
// relative paths.
std::string folder_variable(const char* name)
{
    const char* value = std::getenv(name);
    return value && value[0] == '/' ? value : "";
}

struct Kind { // file names are PREFIX, 16 hexadecimal digits, SUFFIX
    const char *prefix, *suffix;
};
constexpr Kind kKinds[] = {
    {"environment-", ".bnenv"}, {"pipelines-", ".bin"}, {"reference-", ".part"}, {"levels-", ".mip"}, {"sky-", ".vis"}};

bool is_cache_name(const std::string& name)
{
    return std::any_of(std::begin(kKinds), std::end(kKinds), [&](const Kind& kind) {
        constexpr std::size_t kDigits = 16;
        const std::size_t before = std::strlen(kind.prefix), after = std::strlen(kind.suffix);
        return name.size() == before + kDigits + after && name.starts_with(kind.prefix) && name.ends_with(kind.suffix) &&
               name.find_first_not_of("0123456789abcdef", before) == before + kDigits;
    });
}

struct CachedFile {
    fs::file_time_type used;
    fs::path path;
    std::uint64_t bytes;
};

// Lists the cache files in `folder`. Temporary files count too: a killed run may have left some.
std::vector<CachedFile> cached_files(const std::string& folder)
{
    std::vector<CachedFile> files;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        std::error_code gone; // another process may have removed the file
        const std::string name = at->path().filename().string();
        if (!(is_cache_name(name) || is_cache_name(name_of_temporary(name))) || !fs::is_regular_file(at->symlink_status(gone)))
            continue;
        const CachedFile file{at->last_write_time(gone), at->path(), at->file_size(gone)};
        if (!gone)
            files.push_back(file);
    }
    return files;
}

} // namespace

std::string cache_folder()
{
    const std::string xdg = folder_variable("XDG_CACHE_HOME"), home = folder_variable("HOME");
    return !xdg.empty() ? xdg + "/burnish" : !home.empty() ? home + "/.cache/burnish" : "";
}

std::uint64_t cache_limit()
{
    const char* text = std::getenv("BURNISH_CACHE_BYTES");
    if (!text)
        return kDefaultCacheBytes;
    std::uint64_t value = 0;
    const char* end = text + std::strlen(text);
    const auto [rest, error] = std::from_chars(text, end, value);
    const char* const units = "KMG";
    const char* unit = end - rest == 1 ? std::strchr(units, *rest) : nullptr;
    const int shift = unit ? 10 * static_cast<int>(unit - units + 1) : 0;
    if (error != std::errc{} || (rest != end && !unit) || value > UINT64_MAX >> shift)
        return kDefaultCacheBytes;
    return value << shift;
}

CacheUse cache_use(const std::string& folder)
{
    CacheUse use;
    for (const CachedFile& file : cached_files(folder)) {
        ++use.files;
        use.bytes += file.bytes;
    }
    return use;
}

void note_cache_use(const std::string& file)
{
    std::error_code ignored; // on failure the file only looks older than it is
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
}

CacheLock::CacheLock(const std::string& file, double most_seconds, void (*while_waiting)())
{
    // One file holds all locks, each on a byte of its own: a killed holder leaves nothing behind
    const fs::path path(file);
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed); // without a folder there is no lock
    Descriptor opened(
        ::open((path.parent_path() / "locks").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, 0666));
    struct stat info {};
    if (!opened || ::fstat(opened.get(), &info) != 0 || !S_ISREG(info.st_mode))
        return;
    const std::string name = path.filename().string();
    struct flock byte {};
    byte.l_type = F_WRLCK, byte.l_whence = SEEK_SET, byte.l_len = 1;
    byte.l_start = static_cast<off_t>(hash_bytes(name.data(), name.size()) >> 2);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_seconds);
    while (::fcntl(opened.get(), F_OFD_SETLK, &byte) != 0) {
        if ((errno != EAGAIN && errno != EACCES) || std::chrono::steady_clock::now() >= end)
            return;
        waited_ = true;
        if (while_waiting)
            while_waiting();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    lock_.reset(opened.release());
}

void prune_cache(const std::string& folder, std::uint64_t limit, const std::string& keep)
{
    std::vector<CachedFile> files = cached_files(folder);
    std::sort(files.begin(), files.end(),
              [](const CachedFile& a, const CachedFile& b) { return a.used != b.used ? a.used < b.used : a.path < b.path; });
    std::uint64_t bytes = 0;
    const auto is_temporary = [](const CachedFile& file) { return !name_of_temporary(file.path.filename().string()).empty(); };
    std::erase_if(files, [&](const CachedFile& file) { return is_temporary(file) && remove_leftover(file.path.string()); });
    for (const CachedFile& file : files)
        bytes += file.bytes;
    for (const CachedFile& file : files) {
        if (bytes <= limit)
            return;
        std::error_code failed;
        if (file.path == keep || is_temporary(file)) // the second: a running process writes the file
            continue;
        if (fs::remove(file.path, failed) && !failed)
            bytes -= file.bytes;
    }
}

} // namespace burnish
