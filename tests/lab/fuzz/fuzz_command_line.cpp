// libFuzzer entry: any text as a command line, one word a line. The first word is the subcommand. The words are read, and nothing runs.
#include <sstream>
#include <string>
#include <vector>

#include "apps/cli/command.h"
#include "apps/cli/command_line.h"
#include "core/base/check.h"
#include "core/lab/failure_scenes.h"

namespace burnish {
#define BN_LAB_COMMAND(name, summary) Command name##_command();
#include "apps/cli/commands.def"
} // namespace burnish

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    static const bool added = (add_parametric_scenes(failure_scenes()), true);
    BN_CHECK(added);
    std::istringstream lines(std::string(data, data + size));
    std::vector<std::string> words;
    for (std::string line; std::getline(lines, line);)
        words.push_back(line);
    if (words.empty())
        return 0;
    Command (*const makers[])() = {
#define BN_COMMAND(name) &name##_command,
#define BN_LAB_COMMAND(name, summary) &name##_command,
#include "apps/cli/commands.def"
    };
    const std::string first = words[0];
    words.erase(words.begin());
    for (const auto& make : makers) {
        Command command = make();
        if (command.name != first)
            continue;
        static_cast<void>(asked_by(command, words));
        const Status read = read_command_line(command, words);
        if (!read) {
            BN_CHECK(read.error().code == ExitCode::usage && !read.error().reason.empty());
            return 0;
        }
        // Given values can be printed, and printed values can be given again.
        for (const Option& option : command.options.options())
            static_cast<void>(option.help_text());
        BN_CHECK(!help_of(command).empty());
    }
    return 0;
}
