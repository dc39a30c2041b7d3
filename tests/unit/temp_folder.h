// A temporary folder for tests that write files.
#pragma once
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace burnish::test {

// A new folder below the system's temporary place. The destructor removes the folder with its contents.
class TempFolder {
  public:
    TempFolder()
    {
        static std::atomic<int> counter{0};
        folder_ = std::filesystem::temp_directory_path() / ("burnish-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
        std::filesystem::create_directories(folder_);
    }
    ~TempFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    // Writes a file of text or bytes. Returns its path.
    template <class Content> std::string write(const std::string& name, const Content& content) const
    {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << std::string(std::begin(content), std::end(content));
        return path(name);
    }
    std::string write(const std::string& name, const char* content) const { return write(name, std::string(content)); }

  private:
    std::filesystem::path folder_;
};

} // namespace burnish::test
