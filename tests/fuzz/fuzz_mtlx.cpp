// libFuzzer entry: any text as a MaterialX document. What is read has numbers, and makes a material in glTF's ranges.
#include <cmath>
#include <string_view>

#include "core/base/check.h"
#include "core/scene/mtlx/surfaces.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    const auto read = mtlx::read_document({reinterpret_cast<const char*>(data), size}, "fuzz");
    if (!read) {
        BN_CHECK(!read.error().reason.empty());
        return 0;
    }
    BN_CHECK(!read->empty());
    for (const mtlx::SurfaceMaterial& surface : *read) {
        std::vector<std::string> unknown, wanting;
        const mtlx::Parts parts = mtlx::parts_of(surface, unknown);
        const Material m = mtlx::material_of(surface, parts, wanting);
        for (const float share :
             {m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a, m.metallic, m.roughness, m.anisotropy_strength,
              m.transmission, m.clearcoat, m.clearcoat_roughness, m.sheen_roughness, m.iridescence, m.specular})
            BN_CHECK(share >= 0.0f && share <= 1.0f);
    }
    return 0;
}
