#include "core/image/io/image_library.h"

#include <dlfcn.h>
#include <sys/mman.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/image/io/module_hash.h"
#include "core/jobs/threads.h"
#include <burnish_module_hash_value.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "burnish_openimageio.so";
constexpr std::uint64_t kMostModuleBytes = 256u << 20;

// Address space for loading the module. Its libraries map some 500 MiB and start threads; running out of memory ends
// the process.
constexpr std::size_t kRoomBytes = 640u << 20;
// Threads of a pool that one library starts while loading. A refusal ends the process.
constexpr int kLoadThreads = 4;

bool has_room()
{
    void* const room = ::mmap(nullptr, kRoomBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return room != MAP_FAILED && ::munmap(room, kRoomBytes) == 0;
}

// Returns the folder with the program or shared library that holds this code.
fs::path own_folder()
{
    Dl_info info;
    std::error_code ignored;
    if (dladdr(reinterpret_cast<const void*>(&image_library), &info) && info.dli_fname && std::strchr(info.dli_fname, '/'))
        return fs::canonical(info.dli_fname, ignored).parent_path();
    return {};
}

// Lists the folders that may hold the module, in search order. The paths are absolute, so that neither the working
// folder nor LD_LIBRARY_PATH chooses the code to load.
std::vector<fs::path> folders()
{
    std::error_code ignored;
    const fs::path self = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    if (self.empty())
        return {};
    std::vector<fs::path> found = {self, (self / "../lib/burnish").lexically_normal()};
    if (const fs::path own = own_folder(); !own.empty() && own != self)
        found.insert(found.begin(), own / "burnish");                      // the library is installed as lib/libburnish.so
    const fs::path build = fs::weakly_canonical(BN_BUILD_FOLDER, ignored); // holds tests and benchmarks
    if (std::mismatch(build.begin(), build.end(), self.begin(), self.end()).first == build.end() && build != self)
        found.push_back(build);
    return found;
}

Result<const ImageLibrary*> open_library()
{
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler disabled; // the module's libraries leak their load-time allocations when unloaded
#endif
    std::string missing;
    for (const fs::path& folder : folders()) {
        const fs::path path = folder / kModule;
        std::error_code ignored;
        if (!fs::exists(path, ignored)) {
            missing += (missing.empty() ? "" : " or ") + folder.string();
            continue;
        }
        // Check that the module belongs to this build
        const Result<std::vector<std::uint8_t>> bytes = read_file(path.string(), kMostModuleBytes);
        if (!bytes || module_hash(*bytes) != kModuleHash)
            return Error{ExitCode::unavailable, "", "",
                         fmt::format("the image library {} {}", path.string(),
                                     bytes ? "is damaged or belongs to another build" : "cannot be read: " + bytes.error().reason)};
        // Check that memory and threads suffice
        if (!has_room())
            return Error{ExitCode::bad_input, "", "",
                         fmt::format("the image library needs {} MiB of address space, and there is no memory for it", kRoomBytes >> 20)};
        BN_TRY(expect_threads(kLoadThreads, "the image library"));
        // Never closed: some of the module's libraries leave threads and exit handlers.
        void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const symbol = module ? dlsym(module, kImageLibrarySymbol) : nullptr;
        if (!symbol) {
            const char* const why = dlerror();
            return Error{ExitCode::unavailable, "", "",
                         fmt::format("the image library cannot be loaded: {}", first_line(why ? why : kModule))};
        }
        return reinterpret_cast<const ImageLibrary* (*)()>(symbol)();
    }
    return Error{ExitCode::unavailable, "", "", fmt::format("the image library {} is not in {}", kModule, missing)};
}

} // namespace

Result<const ImageLibrary*> image_library(const std::string& file)
{
    static const Result<const ImageLibrary*> opened = open_library();
    if (opened)
        return *opened;
    Error error = opened.error();
    error.file = file;
    return error;
}

} // namespace burnish
