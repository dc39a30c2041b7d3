#include "apps/cli/environment_text.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/text.h"
#include "shading/bake/environment/extracted_lights.h"

namespace burnish {

std::string light_text(const Environment& e)
{
    return fmt::format("mean radiance {:.6g} in the source, {:.6g} in the cube, peak {:.6g}", e.energy_source, e.energy_cube,
                       static_cast<double>(e.peak_source));
}

std::string extracted_light_text(const ExtractedLight& k)
{
    constexpr double kDegrees = 57.295779513082321;
    return fmt::format("{:.1f} % of the light, towards {:.4f},{:.4f},{:.4f}, radius {:.2f} degrees, irradiance {:.4g},{:.4g},{:.4g}",
                       100.0 * static_cast<double>(k.share), k.direction[0], k.direction[1], k.direction[2],
                       kDegrees * static_cast<double>(k.angular_radius), k.irradiance[0], k.irradiance[1], k.irradiance[2]);
}

std::vector<ExtractedLight> turned_extracted_lights(const Environment& environment)
{
    std::vector<ExtractedLight> lights = environment.extracted_lights;
    for (ExtractedLight& light : lights)
        light = turned(light, environment.rotation_deg);
    return lights;
}

void report_extracted_lights(const Environment& environment, Report& report)
{
    for (const ExtractedLight& light : turned_extracted_lights(environment))
        report.detail("extracted light", extracted_light_text(light));
}

Json extracted_lights_json(const std::vector<ExtractedLight>& lights)
{
    const auto vector = [](const float* v) {
        return Json::array({shortest_decimal(v[0]), shortest_decimal(v[1]), shortest_decimal(v[2])});
    };
    Json all = Json::array();
    for (const ExtractedLight& k : lights) {
        Json light;
        light["direction"] = vector(k.direction);
        light["irradiance"] = vector(k.irradiance);
        light["angular_radius_rad"] = shortest_decimal(k.angular_radius);
        light["axis_u"] = vector(k.axis_u);
        light["axis_v"] = vector(k.axis_v);
        light["share"] = shortest_decimal(k.share);
        all.push_back(std::move(light));
    }
    return all;
}

} // namespace burnish
