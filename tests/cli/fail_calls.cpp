// Preloaded before a program, makes one of its calls fail. BN_FAIL=NAME:N fails the N-th call of NAME; NAME:N+ also fails all later ones.
// Allocations count from BN_FAIL_BYTES on (65536), which selects the program's tables and images. fsync_folder counts calls on folders. The
// file BN_FAIL_MARK appears when the call fails. With BN_FAIL set, BN_FAIL_ALWAYS=NAME fails every call of another NAME as well.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

struct Plan {
    char name[32] = "";
    long at = 0;
    bool all_after = false;
    size_t bytes = 65536;
    const char* mark = nullptr;
    const char* always = nullptr;
};

Plan plan;
std::atomic<bool> ready{false};
std::atomic<long> calls{0};

__attribute__((constructor)) void read_plan()
{
    plan.always = getenv("BN_FAIL_ALWAYS");
    const char* text = getenv("BN_FAIL");
    const char* colon = text ? strchr(text, ':') : nullptr;
    if (!colon || static_cast<size_t>(colon - text) >= sizeof(plan.name))
        return;
    memcpy(plan.name, text, static_cast<size_t>(colon - text));
    plan.at = atol(colon + 1);
    plan.all_after = strchr(colon, '+') != nullptr;
    if (const char* bytes = getenv("BN_FAIL_BYTES"))
        plan.bytes = static_cast<size_t>(atol(bytes));
    plan.mark = getenv("BN_FAIL_MARK");
    ready = true;
}

bool fails(const char* name, int code)
{
    if (!ready.load(std::memory_order_relaxed))
        return false;
    if (plan.always && strcmp(name, plan.always) == 0) {
        errno = code;
        return true;
    }
    if (strcmp(name, plan.name) != 0)
        return false;
    const long call = calls.fetch_add(1) + 1;
    if (call != plan.at && !(plan.all_after && call > plan.at))
        return false;
    if (plan.mark) {
        const long fd = syscall(SYS_openat, AT_FDCWD, plan.mark, O_WRONLY | O_CREAT, 0600);
        if (fd >= 0)
            syscall(SYS_close, fd);
    }
    errno = code;
    return true;
}

bool no_memory(size_t size)
{
    return size >= plan.bytes && fails("malloc", ENOMEM);
}

template <class F> F* next(const char* name)
{
    return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" {

void* malloc(size_t size)
{
    return no_memory(size) ? nullptr : __libc_malloc(size);
}
void* calloc(size_t count, size_t size)
{
    return no_memory(count * size) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size)
{
    return no_memory(size) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(size_t alignment, size_t size)
{
    return no_memory(size) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** to, size_t alignment, size_t size)
{
    if (no_memory(size))
        return ENOMEM;
    *to = __libc_memalign(alignment, size);
    return *to ? 0 : ENOMEM;
}

ssize_t write(int fd, const void* data, size_t size)
{
    static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
    return fd > 2 && fails("write", ENOSPC) ? -1 : real(fd, data, size);
}
int fsync(int fd)
{
    static auto* const real = next<int(int)>("fsync");
    struct stat info;
    const bool folder = fstat(fd, &info) == 0 && S_ISDIR(info.st_mode);
    return fails("fsync", EIO) || (folder && fails("fsync_folder", EIO)) ? -1 : real(fd);
}
int rename(const char* from, const char* to)
{
    static auto* const real = next<int(const char*, const char*)>("rename");
    return fails("rename", EIO) ? -1 : real(from, to);
}
int linkat(int a, const char* from, int b, const char* to, int flags)
{
    static auto* const real = next<int(int, const char*, int, const char*, int)>("linkat");
    return fails("linkat", ENOENT) ? -1 : real(a, from, b, to, flags);
}
int flock(int fd, int operation) noexcept
{
    static auto* const real = next<int(int, int)>("flock");
    return fails("flock", ENOLCK) ? -1 : real(fd, operation);
}
ssize_t read(int fd, void* to, size_t size)
{
    static auto* const real = next<ssize_t(int, void*, size_t)>("read");
    return fails("read", EIO) ? -1 : real(fd, to, size);
}
int getentropy(void* to, size_t size)
{
    static auto* const real = next<int(void*, size_t)>("getentropy");
    return fails("getentropy", ENOSYS) ? -1 : real(to, size);
}
int open(const char* path, int flags, ...)
{
    static auto* const real = next<int(const char*, int, ...)>("open");
    va_list more;
    va_start(more, flags);
    const unsigned mode = va_arg(more, unsigned);
    va_end(more);
    const bool writes = (flags & O_ACCMODE) != O_RDONLY;
    if (writes && fails((flags & O_TMPFILE) == O_TMPFILE ? "tmpfile" : "create", (flags & O_TMPFILE) == O_TMPFILE ? EOPNOTSUPP : EACCES))
        return -1;
    return real(path, flags, mode);
}
void* mmap(void* at, size_t size, int protection, int flags, int fd, off_t offset) noexcept
{
    static auto* const real = next<void*(void*, size_t, int, int, int, off_t)>("mmap");
    if (fails("mmap", ENOMEM))
        return MAP_FAILED;
    return real(at, size, protection, flags, fd, offset);
}
}
