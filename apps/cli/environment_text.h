// Describes a baked environment: its light, and the extracted lights taken out of it.
#pragma once
#include <string>

#include "apps/cli/report.h"
#include "apps/report/json.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

std::string light_text(const Environment& environment); // mean and peak radiance
std::string extracted_light_text(const ExtractedLight& light);
void report_extracted_lights(const Environment& environment, Report& report); // with -v

// Returns {direction, irradiance, angular_radius_rad, axis_u, axis_v, share} for each extracted light, the strongest first.
Json extracted_lights_json(const Environment& environment);

} // namespace burnish
