// Replaces compress.cpp in a program without libraries.
#include "core/scene/gltf/compress.h"

namespace burnish::gltf {

namespace {
constexpr const char* kReason = "compressed geometry, and this program was built without meshoptimizer and draco";
} // namespace

void check_meshopt(const Document&, const Json&, const Json&, const std::string& place)
{
    fail(place, kReason);
}

std::vector<std::uint8_t> decode_meshopt(Document&, const Json&, const std::string& place)
{
    fail(place, kReason);
}

DracoPrimitive decode_draco(Document&, const Json&, const Json&, const std::string& place)
{
    fail(place, kReason);
}

} // namespace burnish::gltf
