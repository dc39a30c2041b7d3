// A scene of every kind of table in a few bytes, and a small environment.
#pragma once
#include <memory>

#include "core/scene/check_scene.h"
#include "raster/session/session.h"

namespace burnish::test {

// A quad with a texture, a camera, a lamp and an area light.
inline Scene good_scene()
{
    Scene s;
    const float corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    VertexTable& v = s.vertices;
    for (const auto& p : corners) {
        v.px.push_back(p[0]), v.py.push_back(p[1]), v.pz.push_back(0);
        v.nx.push_back(0), v.ny.push_back(0), v.nz.push_back(1);
        v.u0.push_back(0.5f + 0.5f * p[0]), v.v0.push_back(0.5f - 0.5f * p[1]);
    }
    fill_missing_columns(s);
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
        s.indices.push_back(i);
    Primitive p;
    p.index_count = 6, p.vertex_count = 4, p.has_uv0 = true;
    s.primitives.push_back(p);
    s.meshes.push_back({"quad", 0, 1});
    s.images.push_back(make_image(4, 4, 3, PixelType::u8));
    s.textures.push_back({"grey", 0, WrapMode::repeat, WrapMode::repeat, false});
    s.materials.emplace_back();
    s.materials[0].base_color_tex.texture = 0;
    s.lights.emplace_back();
    s.cameras.emplace_back();
    AreaLight light;
    light.points = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    light.radiance = glm::vec3(1.0f);
    s.area_lights.push_back(light);
    s.nodes.resize(4);
    s.nodes[0].mesh = s.nodes[1].light = s.nodes[2].camera = s.nodes[3].area_light = 0;
    s.nodes[1].parent = 0;
    return s;
}

inline std::shared_ptr<const Environment> small_environment()
{
    static const std::shared_ptr<const Environment> made = [] {
        EnvironmentOptions options;
        options.cube_size = 16, options.samples = 4, options.use_cache = false;
        return *load_shared_environment("builtin:studio", options, {}, Jobs(1));
    }();
    return made;
}

} // namespace burnish::test
