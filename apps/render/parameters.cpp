#include "apps/render/parameters.h"

#include <algorithm>
#include <cstdint>
#include <fmt/core.h>

#include "apps/cli/values.h"

namespace burnish {

std::vector<Option> parameter_options(FrameDesc& to)
{
    std::vector<Option> options;
    for (const ParameterInfo& p : parameters()) {
        Value value = p.number ? number(to.*p.number, p.least, p.most)
                               : integer(to.*p.whole, static_cast<std::int64_t>(p.least), static_cast<std::int64_t>(p.most));
        options.emplace_back(std::string("--") + p.option, p.unit, p.summary, std::move(value));
    }
    return options;
}

std::vector<OptionTable::Taken> taken_parameters()
{
    std::vector<OptionTable::Taken> taken;
    for (const ParameterInfo& p : parameters())
        taken.emplace_back(p.option);
    return taken;
}

Json parameters_json(const FrameDesc& desc)
{
    Json json = Json::object();
    for (const ParameterInfo& p : parameters()) {
        std::string name = p.option;
        std::replace(name.begin(), name.end(), '-', '_');
        json[name] = p.number ? Json(desc.*p.number) : Json(desc.*p.whole);
    }
    return json;
}

std::string parameters_text(const FrameDesc& desc)
{
    std::string text;
    for (const ParameterInfo& p : parameters())
        text += fmt::format(" {}", parameter_of(desc, p));
    return text;
}

} // namespace burnish
