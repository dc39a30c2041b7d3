#include "core/image/image_library.h"

#include <dlfcn.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "burnish_openimageio.so";

// The folders that may hold the module, the first one first. Absolute, so that neither the working folder nor
// LD_LIBRARY_PATH decides what code is loaded.
std::vector<fs::path> folders()
{
    std::error_code ignored;
    const fs::path self = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    if (self.empty())
        return {};
    std::vector<fs::path> found = {self, (self / "../lib/burnish").lexically_normal()};
    const fs::path build =
        fs::weakly_canonical(BN_BUILD_FOLDER, ignored); // tests and benchmarks lie below it
    if (std::mismatch(build.begin(), build.end(), self.begin(), self.end()).first == build.end() &&
        build != self)
        found.push_back(build);
    return found;
}

Result<const ImageLibrary*> open_library()
{
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler disabled; // the libraries behind the module forget, when they are unloaded, what they allocate when loaded
#endif
    std::string missing;
    for (const fs::path& folder : folders()) {
        const fs::path path = folder / kModule;
        std::error_code ignored;
        if (!fs::exists(path, ignored)) {
            missing += (missing.empty() ? "" : " or ") + folder.string();
            continue;
        }
        // Never closed: some of the libraries behind it leave threads and exit handlers.
        void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const symbol = module ? dlsym(module, kImageLibrarySymbol) : nullptr;
        if (!symbol) {
            const char* const why = dlerror();
            return Error{
                ExitCode::unavailable, "", "",
                fmt::format("the image library cannot be loaded: {}", first_line(why ? why : kModule))};
        }
        return reinterpret_cast<const ImageLibrary* (*)()>(symbol)();
    }
    return Error{ExitCode::unavailable, "", "",
                 fmt::format("the image library {} is not in {}", kModule, missing)};
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
