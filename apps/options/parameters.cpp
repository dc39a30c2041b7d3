#include "apps/options/parameters.h"

#include <algorithm>
#include <cstdint>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/field_options.h"
#include "apps/cli/values.h"
#include "core/base/text.h"

namespace burnish {

namespace {

Value parameter_value(const ParameterInfo& p, FrameDesc& to)
{
    if (p.number)
        return number(to.*p.number, p.least, p.most);
    if (p.whole)
        return integer(to.*p.whole, static_cast<std::int64_t>(p.least), static_cast<std::int64_t>(p.most));
    if (p.flag)
        return flag(to.*p.flag);
    if (p.angles)
        return angles_rad(to.*p.angles, p.least, p.most);
    int& place = to.*p.choice;
    return value_detail::name(
        choices_of(p), [&place](std::size_t i) { place = static_cast<int>(i); }, [&place] { return static_cast<std::size_t>(place); });
}

Json parameter_json(const ParameterInfo& p, const FrameDesc& desc)
{
    if (p.number)
        return shortest_decimal(desc.*p.number);
    if (p.whole)
        return desc.*p.whole;
    if (p.flag)
        return desc.*p.flag;
    if (p.angles)
        return Json::array({shortest_decimal((desc.*p.angles).x), shortest_decimal((desc.*p.angles).y)});
    return choices_of(p)[static_cast<std::size_t>(desc.*p.choice)];
}

} // namespace

std::vector<Option> parameter_options(FrameDesc& to)
{
    std::vector<Option> options;
    for (const ParameterInfo& p : parameters())
        options.emplace_back(std::string("--") + p.option, p.choice ? "NAME" : p.unit, with_options(p.summary), parameter_value(p, to));
    return options;
}

Json parameters_json(const FrameDesc& desc)
{
    Json json = Json::object();
    for (const ParameterInfo& p : parameters()) {
        std::string name = p.option;
        std::replace(name.begin(), name.end(), '-', '_');
        json[name + (p.angles ? "_rad" : "")] = parameter_json(p, desc);
    }
    return json;
}

std::string parameters_text(const FrameDesc& desc)
{
    std::string text;
    for (const ParameterInfo& p : parameters())
        text += fmt::format(" {},{}", parameter_of(desc, p).x, parameter_of(desc, p).y);
    return text;
}

} // namespace burnish
