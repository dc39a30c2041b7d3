#include "apps/cli/outputs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "apps/cli/report.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 8> kExtensions = {"exr", "hdr", "pfm", "png", "jpg", "jpeg", "tif", "tiff"};

Error output_error(const std::string& path, const std::string& reason)
{
    return Error{ExitCode::output_failed, path, "", reason};
}

// Checks that the folder exists and is writable. path: the file to be written there.
Status check_writable(const std::string& path, const fs::path& folder)
{
    std::error_code failed;
    const fs::file_status status = fs::status(folder, failed);
    if (status.type() == fs::file_type::not_found)
        return output_error(path, fmt::format("the folder '{}' does not exist", folder.string()));
    if (failed)
        return output_error(path, failed.message());
    if (!fs::is_directory(status))
        return output_error(path, fmt::format("'{}' is not a folder", folder.string()));
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return output_error(path, fmt::format("the folder '{}': {}", folder.string(), std::strerror(errno)));
    return {};
}

Status check_folder(const std::string& path)
{
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0 && errno != ENOENT && errno != ENOTDIR) // such as too long a name or a loop of links
        return output_error(path, std::strerror(errno));
    const fs::path folder = fs::path(written_place(path)).parent_path();
    return check_writable(path, folder.empty() ? "." : folder);
}

// Refuses to overwrite an input: the user's file would be lost.
Status check_not_input(const std::string& path, const std::vector<std::string>& inputs)
{
    std::error_code ignored;
    for (const std::string& input : inputs)
        if (fs::exists(path, ignored) && fs::exists(input, ignored) && fs::equivalent(path, input, ignored))
            return Error{ExitCode::usage, path, "", "is an input of this command"};
    return {};
}

// Returns true for pipes and devices. These are written into; a finished file renamed over them would destroy them.
bool is_special(const std::string& path)
{
    // /dev/stdout may lead to a regular file, but must stay a link.
    for (const char* folder : {"/dev/", "/proc/"})
        if (path.rfind(folder, 0) == 0)
            return true;
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

Status write_stream(std::FILE* stream, const std::string& label, const std::string& text)
{
    const bool whole = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
    if (!whole || std::fflush(stream) != 0)
        return output_error(label, std::strerror(errno));
    return {};
}

} // namespace

std::string extension_of(const std::string& path)
{
    std::string extension = fs::path(path).extension().string();
    if (!extension.empty())
        extension.erase(0, 1);
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

bool same_file(const std::string& a, const std::string& b)
{
    if (is_special(a) && is_special(b))
        return false;
    std::error_code failed, other_failed;
    const auto place = [](const std::string& path, std::error_code& error) {
        const fs::path whole = fs::absolute(written_place(path), error);
        return error ? fs::path() : fs::weakly_canonical(whole, error);
    };
    const fs::path one = place(a, failed), other = place(b, other_failed);
    return a == b || (!failed && !other_failed && one == other);
}

Status check_outputs(const std::vector<std::string>& pictures, const std::vector<std::pair<std::string, std::string>>& texts,
                     const std::vector<std::string>& inputs)
{
    std::vector<std::string> files = pictures;
    for (const std::string& path : pictures)
        BN_TRY(check_picture_path(path, inputs));
    for (const auto& [option, path] : texts) {
        if (path.empty())
            continue;
        BN_TRY(check_text_path(option, path, inputs));
        files.push_back(path);
    }
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (same_file(files[i], files[j]))
                return Error{ExitCode::usage, files[i], "", "is given twice as an output"};
    return {};
}

Status check_picture_path(const std::string& path, const std::vector<std::string>& inputs)
{
    const std::string extension = extension_of(path);
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
        return Error{ExitCode::usage, path, "",
                     fmt::format("the extension is not one of {}", join(std::vector<std::string>(kExtensions.begin(), kExtensions.end())))};
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return output_error(path, "is a folder");
    if (is_special(path))
        return output_error(path, "is not a regular file");
    BN_TRY(check_not_input(path, inputs));
    return check_folder(path);
}

Status check_text_path(const std::string& option, const std::string& path, const std::vector<std::string>& inputs)
{
    if (path.empty())
        return usage_error(option, "is empty");
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return output_error(path, "is a folder");
    if (path == "-" || is_special(path))
        return {};
    BN_TRY(check_not_input(path, inputs));
    return check_folder(path);
}

Status check_folder_path(const std::string& folder)
{
    if (folder.empty())
        return output_error("", "the name of a folder is empty");
    for (fs::path at(folder);; at = at.parent_path()) {
        std::error_code failed;
        const fs::file_status status = fs::status(at.empty() ? "." : at, failed);
        const bool missing = status.type() == fs::file_type::not_found;
        if (failed && !missing)
            return output_error(folder, failed.message());
        if (missing && !fs::is_symlink(fs::symlink_status(at, failed)) && at.has_relative_path())
            continue;
        if (missing)
            return output_error(folder, std::strerror(ENOENT));
        if (!fs::is_directory(status))
            return output_error(folder, at == folder ? "is not a folder" : fmt::format("'{}' is not a folder", at.string()));
        return ::access(at.empty() ? "." : at.c_str(), W_OK | X_OK) == 0 ? Status() : output_error(folder, std::strerror(errno));
    }
}

Status make_output_folder(const std::string& folder)
{
    std::error_code failed, ignored;
    fs::create_directories(folder, failed);
    if (!fs::is_directory(folder, ignored))
        return output_error(folder, failed ? failed.message() : "is not a folder");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return output_error(folder, std::strerror(errno));
    return {};
}

Image display_picture(const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts, Resolve resolve,
                      const Jobs* jobs)
{
    if (linear.channels == 4)
        return tonemap_to_srgb8(unassociated(linear), tonemap, exposure_ev, parts, resolve, jobs);
    return tonemap_to_srgb8(linear, tonemap, exposure_ev, parts, resolve, jobs);
}

Status write_picture(const std::string& path, const Image& linear, Tonemap tonemap, float exposure_ev, const std::vector<PixelPart>& parts,
                     Resolve resolve, const Jobs* jobs)
{
    if (stores_floats(path))
        return write_image(path, linear);
    return write_image(path, display_picture(linear, tonemap, exposure_ev, parts, resolve, jobs), jobs);
}

Status write_text(const std::string& path, const std::string& text)
{
    if (path == "-")
        return write_stream(stdout, "standard output", text);
    if (!is_special(path))
        return write_file(path, text);
    std::FILE* stream = std::fopen(path.c_str(), "wb");
    if (!stream)
        return output_error(path, std::strerror(errno));
    Status status = write_stream(stream, path, text);
    if (std::fclose(stream) != 0 && status)
        status = output_error(path, std::strerror(errno));
    return status;
}

} // namespace burnish
