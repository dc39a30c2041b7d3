// Describes a baked environment: its light, and the extracted lights taken out of it.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/report/json.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

std::string light_text(const Environment& environment); // mean and peak radiance
std::string extracted_light_text(const ExtractedLight& light);
std::vector<ExtractedLight> turned_extracted_lights(const Environment& environment); // as it is turned, the strongest first
void report_extracted_lights(const Environment& environment, Report& report);        // with -v

// {direction, irradiance, angular_radius_rad, axis_u, axis_v, share} each.
Json extracted_lights_json(const std::vector<ExtractedLight>& lights);

} // namespace burnish
