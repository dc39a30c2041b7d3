// `burnish list`: prints the names of option values, the reflection models with their use in --brdf, and the glTF features read. One name
// a line, with a description.
#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/values.h"
#include "core/scene/builtin/builtin.h"
#include "core/scene/gltf/extensions.h"
#include "raster/frame/frame.h"
#include "shading/bake/mip/levels.h"
#include "shading/lang/records.h"

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
    entries.push_back({automatic_technique().name, automatic_technique().summary});
    for (const TechniqueInfo& technique : techniques())
        entries.push_back({technique.name, with_options(technique.summary)});
    return entries;
}

// Names the options that accept the model.
const char* model_use(const ModelInfo& model)
{
    if (model.lobe < 0)
        return "-";
    return model.lobe_traits & kPunctualOnly ? "--brdf, lights" : "--brdf";
}

std::vector<Entry> model_entries()
{
    std::vector<Entry> entries;
    for (const ModelInfo& model : models())
        entries.push_back({model.name, fmt::format("{:<15}{}", model_use(model), model.summary)});
    return entries;
}

std::vector<Entry> area_way_entries()
{
    std::vector<Entry> entries;
    for (const AreaWayInfo& way : area_ways())
        entries.push_back({way.name, with_options(way.summary)});
    return entries;
}

std::vector<Entry> mip_filter_entries()
{
    std::vector<Entry> entries;
    for (const MipFilterInfo& filter : mip_filters())
        entries.push_back({filter.name, with_options(filter.summary)});
    return entries;
}

std::vector<Entry> extension_entries()
{
    std::vector<Entry> entries;
    for (const GltfFeature& feature : gltf_features()) {
        const std::string what = feature.what;
        entries.push_back(
            {feature.name, fmt::format("{:<9}{}{}", support_name(feature.support), what.empty() ? "" : "  ", with_options(what))});
    }
    return entries;
}

void print(const std::vector<Entry>& entries)
{
    std::size_t width = 0;
    for (const Entry& entry : entries)
        width = std::max(width, entry.name.size());
    for (const Entry& entry : entries)
        fmt::print("{:<{}}  {}\n", entry.name, width, entry.summary);
}

} // namespace

Command list_command()
{
    struct Kind {
        const char* name;
        std::vector<Entry> (*entries)();
    };
    static constexpr Kind kKinds[] = {{"techniques", technique_entries},
                                      {"scenes", [] { return builtins(builtin_scenes()); }},
                                      {"environments", [] { return builtins(builtin_environments()); }},
                                      {"models", model_entries},
                                      {"area-lights", area_way_entries},
                                      {"mip-filters", mip_filter_entries},
                                      {"extensions", extension_entries}};
    std::vector<std::string> names = {"all"};
    for (const Kind& kind : kKinds)
        names.push_back(kind.name);
    auto what = std::make_shared<std::string>("all");
    OptionTable table;
    table.add("", {Option("WHAT", "", "{}", choice(*what, names))});
    return {"list", "List names that options accept, reflection models, and supported glTF features", table,
            "Examples:\n  burnish list\n  burnish list techniques", [what](OptionTable&) {
                for (const Kind& kind : kKinds) {
                    if (*what == "all")
                        fmt::print("{}{}:\n", &kind == kKinds ? "" : "\n", kind.name);
                    if (*what == "all" || *what == kind.name)
                        print(kind.entries());
                }
                return 0;
            }};
}

} // namespace burnish
