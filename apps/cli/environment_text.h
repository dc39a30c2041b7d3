// What is said about a baked environment: its light, and the key lights that left it.
#pragma once
#include <string>

#include "apps/cli/report.h"
#include "apps/report/json.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

std::string light_text(const Environment& environment); // its mean and peak radiance
std::string key_light_text(const KeyLight& light);
void report_key_lights(const Environment& environment, Report& report); // with -v

// {direction, irradiance, angular_radius_rad, axis_u, axis_v, share} each, the strongest first.
Json key_lights_json(const Environment& environment);

} // namespace burnish
