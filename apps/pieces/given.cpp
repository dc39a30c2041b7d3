#include "apps/pieces/given.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <iterator>
#include <string_view>
#include <vector>

#include "core/base/file.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Options that change no picture, and the scene, of which other hashes tell the content.
constexpr std::string_view kChangesNothing[] = {"--quiet", "--verbose", "--threads", "--isa", "--tile-size", "--no-cache", "SCENE"};

// Returns a hash over the content of a file, or over names and content of a folder's files. Missing files have a hash, too.
std::uint64_t hash_of_files(const std::string& path)
{
    std::vector<std::string> files;
    std::error_code failed, ignored;
    const bool is_folder = fs::is_directory(path, ignored);
    if (is_folder)
        for (fs::recursive_directory_iterator at(path, failed), end; !failed && at != end; at.increment(failed))
            files.push_back(at->path());
    else
        files.push_back(path);
    std::sort(files.begin(), files.end());
    std::uint64_t hash = files.size();
    for (const std::string& file : files) {
        const std::string name = is_folder ? fs::path(file).lexically_relative(path).string() : "";
        hash = hash_bytes(name.data(), name.size(), hash);
        const Result<std::vector<std::uint8_t>> bytes = read_file(file, std::uint64_t{1} << 36);
        hash = bytes ? hash_bytes(bytes->data(), bytes->size(), hash + 1) : hash + 2;
    }
    return hash;
}

} // namespace

std::string text_of_given(const OptionTable& given)
{
    std::string text;
    for (const Option& option : given.options()) {
        const bool elsewhere = option.output || option.group.starts_with("Pieces") || option.name.starts_with("--limit-") ||
                               std::find(std::begin(kChangesNothing), std::end(kChangesNothing), option.name) != std::end(kChangesNothing);
        if (!option.given || elsewhere)
            continue;
        const bool file = option.value.kind == ValueKind::file || option.value.kind == ValueKind::folder;
        text += "\n" + option.name;
        for (const std::string& word : option.texts)
            text += file && !word.starts_with("builtin:") ? fmt::format(" {:016x}", hash_of_files(word)) : " " + word;
    }
    return text;
}

std::string text_of_scene(const std::string& word, const std::vector<std::string>& files)
{
    std::string text = "\n" + (files.empty() ? word : std::string("files"));
    for (const std::string& file : files)
        text += fmt::format(" {:016x}", hash_of_files(file));
    return text;
}

} // namespace burnish
