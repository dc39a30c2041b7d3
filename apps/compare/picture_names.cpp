#include "apps/compare/picture_names.h"

#include <algorithm>
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

// Adds the parts of a folder's picture names that the pattern's '*' covers. Like a shell, passes over names that begin with a dot.
Status add_covered_parts(const std::string& pattern, std::set<std::string>& parts)
{
    const fs::path path(pattern);
    const std::string name = path.filename().string();
    const std::size_t star = name.find('*');
    if (star == std::string::npos || std::count(pattern.begin(), pattern.end(), '*') != 1)
        return Error{ExitCode::usage, "", "PATH", "'" + pattern + "' needs one '*', in the file name"};
    const std::string before = name.substr(0, star), after = name.substr(star + 1);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code failed;
    fs::directory_iterator at(folder, failed);
    for (; !failed && at != fs::directory_iterator(); at.increment(failed)) {
        const std::string found = at->path().filename().string();
        std::error_code ignored; // of a link to nowhere, which cannot be read later
        if (found.size() < before.size() + after.size() || !found.starts_with(before) || !found.ends_with(after) ||
            (found[0] == '.' && before.empty()) || !is_picture(at->path()) || at->is_directory(ignored))
            continue;
        parts.insert(found.substr(before.size(), found.size() - before.size() - after.size()));
    }
    if (failed)
        return Error{ExitCode::bad_input, folder.string(), "", failed.message()};
    return {};
}

} // namespace

Result<std::vector<std::string>> covered_parts(const std::string& expected, const std::string& actual)
{
    std::set<std::string> parts;
    BN_TRY(add_covered_parts(expected, parts));
    BN_TRY(add_covered_parts(actual, parts));
    if (parts.empty())
        return Error{ExitCode::bad_input, expected, "", "matches no picture"};
    return std::vector<std::string>(parts.begin(), parts.end());
}

std::string with_part(const std::string& pattern, const std::string& part)
{
    std::string path = pattern;
    return path.replace(path.find('*'), 1, part);
}

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
