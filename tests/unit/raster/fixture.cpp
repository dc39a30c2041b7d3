#include "tests/unit/raster/fixture.h"

#include <gtest/gtest.h>

#include "raster/tile/tile_types.h"

namespace burnish::test {

std::vector<Isa> available_isas()
{
    return isas_with<TileFns>();
}

std::uint64_t Random::next()
{
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

Scene scene_of(const std::vector<Triangle>& triangles, bool double_sided)
{
    Scene s;
    VertexTable& v = s.vertices;
    for (const Triangle& t : triangles) {
        const glm::vec3 c = glm::cross(t[1] - t[0], t[2] - t[0]);
        const glm::vec3 n = glm::dot(c, c) > 0.0f ? glm::normalize(c) : glm::vec3(0, 0, 1);
        const glm::vec3 side = std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        const glm::vec3 tangent = glm::normalize(glm::cross(side, n));
        for (const glm::vec3& p : t) {
            s.indices.push_back(static_cast<std::uint32_t>(v.size()));
            v.px.push_back(p.x), v.py.push_back(p.y), v.pz.push_back(p.z);
            v.nx.push_back(n.x), v.ny.push_back(n.y), v.nz.push_back(n.z);
            v.tx.push_back(tangent.x), v.ty.push_back(tangent.y), v.tz.push_back(tangent.z), v.tw.push_back(1.0f);
            for (Column<float>* c0 : {&v.u0, &v.v0, &v.u1, &v.v1})
                c0->push_back(0.0f);
            for (Column<float>* c1 : {&v.cr, &v.cg, &v.cb, &v.ca})
                c1->push_back(1.0f);
        }
    }
    Primitive p;
    p.index_count = static_cast<std::uint32_t>(s.indices.size());
    p.vertex_count = static_cast<std::uint32_t>(v.size());
    s.primitives.push_back(p);
    s.meshes.push_back({"triangles", 0, 1});
    Node node;
    node.mesh = 0;
    s.nodes.push_back(node);
    Material m;
    m.double_sided = double_sided;
    s.materials.push_back(m);
    update_world(s);
    return s;
}

std::vector<Triangle> tessellated_box(float half, int cells)
{
    std::vector<Triangle> out;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2)
            for (int j = 0; j < cells; ++j)
                for (int i = 0; i < cells; ++i) {
                    const auto corner = [&](int a, int b) {
                        glm::vec3 p;
                        p[axis] = half * static_cast<float>(side);
                        p[(axis + 1) % 3] = half * (2.0f * static_cast<float>(a) / static_cast<float>(cells) - 1.0f);
                        p[(axis + 2) % 3] = half * (2.0f * static_cast<float>(b) / static_cast<float>(cells) - 1.0f);
                        return p;
                    };
                    out.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
                    out.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
                }
    return out;
}

Scene plate(float metallic)
{
    Scene scene = scene_of(
        {{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0)}, {glm::vec3(-1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)}},
        false);
    scene.materials[0].metallic = metallic;
    scene.materials[0].base_color = glm::vec4(0.8f, 0.5f, 0.3f, 1.0f);
    return scene;
}

void add_lamp(Scene& to, const glm::vec3& at, float intensity, float range)
{
    Light light;
    light.intensity = intensity, light.range = range;
    Node node;
    node.light = static_cast<int>(to.lights.size());
    node.local[3] = glm::vec4(at, 1.0f);
    to.lights.push_back(light);
    to.nodes.push_back(node);
    update_world(to);
}

namespace {

Environment constant_environment(float radiance, const Jobs& jobs)
{
    Image image = make_image(16, 8, 3, PixelType::f32);
    for (int i = 0; i < 16 * 8 * 3; ++i)
        image.f32()[i] = radiance;
    EnvironmentOptions options;
    options.cube_size = 16;
    options.samples = 64;
    options.use_cache = false;
    Result<Environment> environment = bake_environment(image, "constant", options, jobs);
    EXPECT_TRUE(environment);
    return *environment;
}

} // namespace

struct Stage::Parts {
    Parts(Scene s, float radiance, int threads)
        : data{"", std::move(s), {}, {}}, jobs(threads), environment(constant_environment(radiance, jobs)), dfg(bake_dfg(32, 256, jobs))
    {
        data.tables = make_draw_tables(data.scene);
    }
    SceneData data;
    Jobs jobs;
    Environment environment;
    DfgTable dfg;
};

Stage::Stage(Scene s, float radiance, int threads) : Stage(std::make_shared<Parts>(std::move(s), radiance, threads)) {}

Stage::Stage(const std::shared_ptr<Parts>& p)
    : parts_(p), scene(p->data.scene), tables(p->data.tables), mips(p->data.mips), environment(p->environment), dfg(p->dfg), jobs(p->jobs)
{
}

SessionParts Stage::parts() const
{
    const auto part = [&](const auto& of) { return std::shared_ptr<const std::remove_cvref_t<decltype(of)>>(parts_, &of); };
    return {part(parts_->data), part(parts_->environment), part(parts_->jobs), part(parts_->dfg)};
}

Frame Stage::render(const FrameDesc& desc, Isa isa) const
{
    SessionOptions options;
    options.isa = isa;
    Result<Session> session = Session::make(parts(), options);
    EXPECT_TRUE(session) << (session ? "" : session.error().line());
    Result<Frame> frame = session->render(desc);
    EXPECT_TRUE(frame) << (frame ? "" : frame.error().line());
    return *frame;
}

View pixel_view(int width, int height)
{
    View v;
    v.eye = {0.5f * static_cast<float>(width), -0.5f * static_cast<float>(height), 1.0f};
    v.orthographic = true;
    v.tan_half_x = 0.5f * static_cast<float>(width), v.tan_half_y = 0.5f * static_cast<float>(height);
    v.znear = 0.0f, v.zfar = 2.0f;
    return v;
}

} // namespace burnish::test
