// `burnish serve`: a page on this machine that draws scenes.
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/serve/server.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(Open the printed address in a browser. Drag to turn, with Shift to move, and use the wheel to zoom. Every option of the picture stands
beside it, for two settings A and B: side by side, their difference, and the reference. The page shows the command that draws the same
picture. The server listens on 127.0.0.1 alone, and takes no request without the address's token. It writes nothing but the cache, and
pictures into the folder of -o. Ctrl-C ends it.

Examples:
  burnish serve
  burnish serve lamp.glb --watch
  burnish serve models/ -o pictures)";

constexpr const char* kLimits = "Limits on input";

struct ServeArguments {
    ServeSetting setting;
};

int run_serve(ServeArguments& arguments, const OptionTable& given)
{
    ServeSetting& setting = arguments.setting;
    for (const Option& option : given.options())
        if (option.given && option.group == kLimits) {
            setting.limit_words.push_back(option.name);
            if (option.takes_value())
                setting.limit_words.push_back(option.value.get());
        }
    const std::atomic<bool>& stop = watch_stop_signals();
    const Status served = serve(setting, stop, [](const std::string& address) {
        std::fputs((address + "\n").c_str(), stdout);
        std::fflush(stdout);
    });
    return served ? 0 : fail(served.error());
}

OptionTable serve_option_table(ServeArguments& to)
{
    OptionTable table;
    table.add("", {Option("SCENE", "", "A .gltf, .glb or .obj file, a folder of them and of environments, or builtin:NAME",
                          text(to.setting.target), "built-in scenes")});
    table.add("Serving", {{"--port", "N", "Port on 127.0.0.1", integer(to.setting.port, 0, 65535), "one that is free"},
                          {"--watch", "", "Draw again where a file of the scene changes, and list new files", flag(to.setting.watch)}});
    table.add("Output", {{"-o,--output", "FOLDER", "Folder where the page may save pictures", folder(to.setting.output_folder), "none"}});
    table.add("Machine", {threads_option(to.setting.threads, "Worker threads; never changes a picture")});
    table.add(kLimits, limit_options(to.setting.limits));
    return table;
}

} // namespace

Command serve_command()
{
    auto arguments = std::make_shared<ServeArguments>();
    return {"serve", "Show scenes in a browser, with every option of the picture", serve_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_serve(*arguments, given); }};
}

} // namespace burnish
