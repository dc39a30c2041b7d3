#include "raster/frame/area_light_text.h"

#include <algorithm>
#include <fmt/format.h>

#include "core/base/text.h"
#include "core/scene/area_light.h"
#include "raster/frame/comma_numbers.h"

namespace burnish {
namespace {

std::string joined(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names)
        out += (out.empty() ? "" : ", ") + name;
    return out;
}

// Returns true where the text is three numbers.
bool put_three(const std::string& text, glm::vec3& to)
{
    const std::optional<std::vector<float>> numbers = comma_numbers(text);
    if (!numbers || numbers->size() != 3)
        return false;
    to = glm::vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    return true;
}

// Sets the value of a key. Returns the reason why it cannot, or an empty text.
std::string put_key(AreaLight& light, const std::string& key, const std::string& value)
{
    constexpr float kMostRadius = 1e30f;
    const auto no_three = [](const std::string& text) { return fmt::format("expected three numbers such as 1,0.5,2, got '{}'", text); };
    if (key == "two-sided")
        light.two_sided = true;
    if (key == "solid")
        light.solid = true;
    if (key == "texture") {
        if (value.empty())
            return "texture names no file";
        light.texture_file = value;
    }
    for (const std::string& triple : key == "points" ? split(value, '/') : std::vector<std::string>())
        if (!put_three(triple, light.points.emplace_back()))
            return "points: " + no_three(triple);
    if (key == "radiance" && !put_three(value, light.radiance))
        return "radiance: " + no_three(value);
    if (key == "radius") {
        const std::optional<std::vector<float>> numbers = comma_numbers(value);
        if (!numbers || numbers->size() != 1 || !((*numbers)[0] >= 0.0f && (*numbers)[0] <= kMostRadius))
            return fmt::format("radius: expected a number from 0 to {:g}, got '{}'", kMostRadius, value);
        light.radius = (*numbers)[0];
    }
    return "";
}

} // namespace

Result<AreaLight> area_light_of(const std::string& text, const NameHint& hint)
{
    const auto refuse = [&](const std::string& reason) { return Error{ExitCode::usage, "", "", fmt::format("'{}': {}", text, reason)}; };
    const auto hinted = [&](const std::string& word, const std::vector<std::string>& names) { return hint ? hint(word, names) : ""; };
    // Read the shape
    const std::vector<std::string> parts = split(text, ':');
    std::vector<std::string> shapes;
    for (int i = 0; i < kAreaShapes; ++i)
        shapes.emplace_back(area_shape_info(static_cast<AreaShape>(i)).name);
    const auto shape = std::find(shapes.begin(), shapes.end(), parts[0]);
    if (shape == shapes.end())
        return refuse(fmt::format("begins with none of {}{}", joined(shapes), hinted(parts[0], shapes)));
    AreaLight light;
    light.shape = static_cast<AreaShape>(shape - shapes.begin());
    // Read the keys
    const std::vector<std::string> keys = {"points", "radius", "radiance", "two-sided", "solid", "texture"};
    std::vector<std::string> seen;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equal = std::min(parts[i].find('='), parts[i].size());
        const std::string key = parts[i].substr(0, equal), value = parts[i].substr(std::min(equal + 1, parts[i].size()));
        if (std::find(keys.begin(), keys.end(), key) == keys.end() || (equal == parts[i].size()) != (key == "two-sided" || key == "solid"))
            return refuse(fmt::format("'{}' is none of points=X,Y,Z/X,Y,Z..., radius=R, radiance=R,G,B, two-sided, solid, texture=FILE{}",
                                      parts[i], hinted(key, keys)));
        if (std::find(seen.begin(), seen.end(), key) != seen.end())
            return refuse(fmt::format("{} is given twice", key));
        seen.push_back(key);
        if (const std::string fault = put_key(light, key, value); !fault.empty())
            return refuse(fault);
    }
    // Check the whole light
    if (std::find(seen.begin(), seen.end(), "radiance") == seen.end())
        return refuse("has no radiance=R,G,B");
    if (const std::string fault = area_light_fault(light); !fault.empty())
        return refuse(fault);
    return light;
}

} // namespace burnish
