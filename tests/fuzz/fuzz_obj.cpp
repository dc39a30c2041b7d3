// libFuzzer entry: any text as an OBJ file, and as a material library. A loaded scene must be consistent.
#include <cmath>
#include <string>

#include "core/base/check.h"
#include "core/scene/obj/mtl.h"
#include "core/scene/obj/obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace burnish;
    Limits limits;
    limits.accessor_bytes = 1u << 20;
    const obj::MtlLibrary library = obj::parse_mtl("fuzz", std::string(data, data + size));
    BN_CHECK(!library.wrong || !library.wrong->reason.empty());
    for (const obj::MtlMaterial& m : library.materials)
        BN_CHECK(m.roughness.value_or(0.0f) >= 0.0f && m.roughness.value_or(0.0f) <= 1.0f && std::isfinite(m.rotation.value_or(0.0f)));
    const Result<Scene> scene = load_obj_text(std::string(data, data + size), "fuzz", limits);
    if (!scene) {
        BN_CHECK(!scene.error().reason.empty());
        return 0;
    }
    BN_CHECK(!scene->primitives.empty());
    for (const Primitive& p : scene->primitives) {
        BN_CHECK(p.index_count > 0 && p.index_count % 3 == 0);
        for (std::uint32_t i = 0; i < p.index_count; ++i)
            BN_CHECK(scene->indices[p.first_index + i] - p.first_vertex < p.vertex_count);
    }
    const VertexTable& v = scene->vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
        for (const float number :
             {v.px[i], v.py[i], v.pz[i], v.nx[i], v.ny[i], v.nz[i], v.tx[i], v.ty[i], v.tz[i], v.u0[i], v.v0[i], v.cr[i], v.cg[i], v.cb[i]})
            BN_CHECK(std::isfinite(number));
    return 0;
}
