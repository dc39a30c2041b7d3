// Parameters of frames by names and texts.
#include <algorithm>
#include <optional>

#include "raster/frame/comma_numbers.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

std::optional<double> flag_of(const std::string& text)
{
    if (text == "true" || text == "1")
        return 1.0;
    return text == "false" || text == "0" ? std::optional(0.0) : std::nullopt;
}

} // namespace

Status set_parameter(FrameDesc& desc, const std::string& name, const std::string& value)
{
    const auto known = std::find_if(parameters().begin(), parameters().end(), [&](const ParameterInfo& p) { return p.option == name; });
    if (known == parameters().end())
        return Error{ExitCode::usage, "", name, "is no parameter of frames"};
    const ParameterInfo& p = *known;
    const auto wrong = [&](const std::string& reason) {
        return Error{ExitCode::usage, "", "", reason, std::string("FrameDesc::") + p.name};
    };
    // A choice, by its name
    if (const std::vector<std::string> names = choices_of(p); !names.empty()) {
        const auto at = std::find(names.begin(), names.end(), value);
        if (at == names.end()) {
            std::string known_names;
            for (const std::string& one : names)
                known_names += (known_names.empty() ? "" : ", ") + one;
            return wrong("'" + value + "' is none of " + known_names);
        }
        return set_parameter(desc, p, static_cast<double>(at - names.begin()));
    }
    if (p.flag) {
        const std::optional<double> on = flag_of(value);
        if (!on)
            return wrong("'" + value + "' is neither true nor false");
        return set_parameter(desc, p, *on);
    }
    // Numbers
    const std::optional<std::vector<float>> numbers = comma_numbers(value);
    if (!numbers || numbers->size() != (p.angles ? 2u : 1u))
        return wrong("'" + value + (p.angles ? "' is not two numbers with a comma between" : "' is no number"));
    for (const float number : *numbers)
        if (!(static_cast<double>(number) >= p.least && static_cast<double>(number) <= p.most))
            return wrong("'" + value + "' is out of range");
    if (p.angles)
        desc.*p.angles = glm::radians(glm::vec2((*numbers)[0], (*numbers)[1]));
    else
        return set_parameter(desc, p, static_cast<double>(numbers->front()));
    return {};
}

} // namespace burnish
