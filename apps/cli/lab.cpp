#include "apps/cli/lab.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <system_error>
#include <unistd.h>

#include "apps/cli/report.h"
#include "apps/cli/words.h"

namespace burnish {

int start_lab()
{
    return start_lab(command_words());
}

int start_lab(const std::vector<std::string>& words, const std::string& reason)
{
    std::error_code failed;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed)
        return fail(Error{ExitCode::unavailable, "/proc/self/exe", "", "burnish-lab cannot be found: " + failed.message()});
    const std::string program = (self.parent_path() / "burnish-lab").string();
    std::string name = "burnish"; // of messages
    std::vector<std::string> copies = words;
    std::vector<char*> arguments = {name.data()};
    for (std::string& word : copies)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    const char* const help = errno == ENOENT ? "; make it with `cmake --build build/release --target burnish-lab`" : "";
    return fail(Error{ExitCode::unavailable, program, "",
                      fmt::format("{} '{}', and cannot be started: {}{}", reason.empty() ? "runs" : "has",
                                  !reason.empty() ? reason
                                  : words.empty() ? ""
                                                  : words[0],
                                  std::strerror(errno), help)});
}

} // namespace burnish
