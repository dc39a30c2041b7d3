#include "apps/compare/picture_names.h"

#include <filesystem>
#include <set>
#include <system_error>

#include "apps/cli/outputs.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

bool is_picture(const fs::path& path)
{
    const std::string extension = extension_of(path.string());
    for (const char* known : {"png", "exr", "hdr", "pfm", "tif", "tiff", "jpg", "jpeg", "webp", "bmp", "ppm"})
        if (extension == known)
            return true;
    return false;
}

} // namespace

Result<std::vector<std::string>> picture_names(const std::string& expected, const std::string& actual)
{
    std::error_code failed;
    std::set<std::string> names;
    for (const std::string& folder : {expected, actual}) {
        fs::recursive_directory_iterator at(folder, failed);
        for (; !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
            std::error_code ignored; // of a link to nowhere, which cannot be read later
            if (is_picture(at->path()) && !at->is_directory(ignored))
                names.insert(at->path().lexically_relative(folder).string());
        }
        if (failed)
            return Error{ExitCode::bad_input, folder, "", failed.message()};
    }
    if (names.empty())
        return Error{ExitCode::bad_input, expected, "", "holds no picture"};
    return std::vector<std::string>(names.begin(), names.end());
}

} // namespace burnish
