// Test data files. tests/data holds the files that every test needs. An optional second folder holds more files in the same tree, and tests
// that iterate over a folder then have more cases.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace burnish::test {

inline constexpr const char* kDataFolders[] = {BN_TEST_DATA, BN_SHARED_DATA};

// Returns the path of tests/data/NAME. If this file is missing, returns NAME's path in the optional folder.
inline std::string data_file(const std::string& name)
{
    for (const std::string folder : kDataFolders)
        if (std::filesystem::exists(folder + "/" + name))
            return folder + "/" + name;
    return std::string(BN_TEST_DATA) + "/" + name;
}

inline bool has_data_file(const std::string& name)
{
    return std::filesystem::exists(data_file(name));
}

// Returns the paths of all files below FOLDER in both places, sorted by name, each name once.
inline std::vector<std::string> data_files(const std::string& folder)
{
    std::map<std::string, std::string> found; // name, path
    for (const std::string root : kDataFolders) {
        if (!std::filesystem::exists(root + "/" + folder))
            continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root + "/" + folder))
            if (entry.is_regular_file())
                found.emplace(std::filesystem::relative(entry.path(), root).string(), entry.path().string());
    }
    std::vector<std::string> paths;
    for (const auto& [name, path] : found)
        paths.push_back(path);
    return paths;
}

} // namespace burnish::test
