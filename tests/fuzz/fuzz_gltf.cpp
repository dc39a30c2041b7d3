// libFuzzer entry: any bytes as a glTF file. A loaded scene must be consistent.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/check.h"
#include "core/image/io/image_library.h"
#include "core/scene/gltf/gltf.h"
#include "core/scene/image_light.h"

// Loads the image library's hundreds of files before a run's clock starts.
extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    static_cast<void>(static_cast<bool>(burnish::image_library("fuzz")));
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    burnish::Limits limits;
    limits.image_side = 256;
    limits.texture_bytes = 16u << 20;
    limits.accessor_bytes = 16u << 20;
    const burnish::Result<burnish::Scene> scene = burnish::load_gltf_bytes(data, size, "fuzz", limits);
    if (!scene) {
        BN_CHECK(!scene.error().reason.empty());
        return 0;
    }
    for (const burnish::Primitive& p : scene->primitives)
        for (std::uint32_t i = 0; i < p.index_count; ++i)
            BN_CHECK(scene->indices[p.first_index + i] - p.first_vertex < p.vertex_count);
    for (std::size_t i = 0; i < scene->vertices.size(); ++i)
        BN_CHECK(std::isfinite(scene->vertices.px[i] + scene->vertices.nx[i] + scene->vertices.tx[i]));
    if (scene->image_light)
        if (const burnish::Result<burnish::ImageLight> light = burnish::load_image_light_bytes(data, size, "fuzz", limits))
            for (const burnish::Image& face : light->faces)
                BN_CHECK(face.width == light->size && face.height == light->size);
    return 0;
}
