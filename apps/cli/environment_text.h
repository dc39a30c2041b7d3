// Describes a baked environment: its light, and the key lights taken out of it.
#pragma once
#include <string>

#include "apps/cli/report.h"
#include "apps/report/json.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

std::string light_text(const Environment& environment); // mean and peak radiance
std::string key_light_text(const KeyLight& light);
void report_key_lights(const Environment& environment, Report& report); // with -v

// Returns {direction, irradiance, angular_radius_rad, axis_u, axis_v, share} for each key light, the strongest first.
Json key_lights_json(const Environment& environment);

} // namespace burnish
