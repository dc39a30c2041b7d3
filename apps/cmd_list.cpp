// `burnish list`: the names that options accept, one a line with what it is.
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

#include "apps/command.h"
#include "core/scene/builtin.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

struct Entry {
    std::string name, summary;
};

std::vector<Entry> builtins(const std::vector<BuiltinInfo>& infos)
{
    std::vector<Entry> entries;
    for (const BuiltinInfo& info : infos)
        entries.push_back({std::string("builtin:") + info.name, info.summary});
    return entries;
}

std::vector<Entry> technique_entries()
{
    std::vector<Entry> entries;
    for (const TechniqueInfo& technique : techniques())
        entries.push_back({technique.name, technique.summary});
    return entries;
}

std::vector<Entry> model_entries()
{
    std::vector<Entry> entries;
    for (const ModelInfo& model : models())
        entries.push_back({model.name, model.summary});
    return entries;
}

int print(const std::vector<Entry>& entries)
{
    std::size_t width = 0;
    for (const Entry& entry : entries)
        width = std::max(width, entry.name.size());
    for (const Entry& entry : entries)
        fmt::print("{:<{}}  {}\n", entry.name, width, entry.summary);
    return 0;
}

} // namespace

Command add_list(CLI::App& program)
{
    CLI::App* app = program.add_subcommand("list", "List the names that options accept");
    auto what = std::make_shared<std::string>();
    app->add_option("WHAT", *what, "techniques, scenes, environments or models")
        ->required()
        ->check(CLI::IsMember({"techniques", "scenes", "environments", "models"}));
    app->footer("Examples:\n  burnish list techniques\n  burnish list scenes");
    return {app, [what] {
                if (*what == "scenes")
                    return print(builtins(builtin_scenes()));
                if (*what == "environments")
                    return print(builtins(builtin_environments()));
                if (*what == "models")
                    return print(model_entries());
                return print(technique_entries());
            }};
}

} // namespace burnish
