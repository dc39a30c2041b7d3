// Parses option values beyond plain numbers: sizes, vectors, byte counts. Every error names the expected format.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/text.h"
#include "core/scene/scene.h"

namespace burnish {

struct PictureSize {
    int width = 0, height = 0;
};

Result<PictureSize> parse_picture_size(const std::string& option, const std::string& text); // "1280x720"
Result<glm::vec3> parse_vec3(const std::string& option, const std::string& text);           // "x,y,z", finite
Result<glm::dvec3> parse_dvec3(const std::string& option, const std::string& text);         // with double precision
Result<double> parse_number(const std::string& option, const std::string& text, double low, double high);
Result<std::int64_t> parse_integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high);
Result<std::uint64_t> parse_bytes(const std::string& option,
                                  const std::string& text); // "500", "64K", "512M", "4G"
// As area_light_of(), with hints at names.
Result<AreaLight> parse_area_light(const std::string& option, const std::string& text);

std::vector<std::string> technique_names(); // auto, then all techniques in registry order

// Parses "all" or names with commas between; returns registry order.
Result<std::vector<std::string>> parse_techniques(const std::string& text, const std::string& option = "--techniques");

} // namespace burnish
