#include "tests/unit/worlds/world.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <memory>

#include "core/base/result.h"
#include "core/scene/gltf/gltf.h"

namespace burnish::test {

std::uint64_t Dice::next()
{
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

glm::vec3 Dice::direction()
{
    for (;;) {
        const glm::vec3 d(between(-1, 1), between(-1, 1), between(-1, 1));
        const float length = glm::length(d);
        if (length > 0.1f && length < 1.0f)
            return d / length;
    }
}

int World::add(const std::vector<glm::vec3>& corners, const Material& material, const glm::mat4& placed, int parent)
{
    VertexTable& v = scene.vertices;
    Primitive p;
    p.first_index = static_cast<std::uint32_t>(scene.indices.size()), p.first_vertex = static_cast<std::uint32_t>(v.size());
    p.index_count = p.vertex_count = static_cast<std::uint32_t>(corners.size());
    p.material = static_cast<int>(scene.materials.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t first = i / 3 * 3;
        const glm::vec3 n = glm::normalize(glm::cross(corners[first + 1] - corners[first], corners[first + 2] - corners[first]));
        const glm::vec3 t = glm::normalize(glm::cross(std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
        scene.indices.push_back(static_cast<std::uint32_t>(v.size()));
        v.px.push_back(corners[i].x), v.py.push_back(corners[i].y), v.pz.push_back(corners[i].z);
        v.nx.push_back(n.x), v.ny.push_back(n.y), v.nz.push_back(n.z);
        v.tx.push_back(t.x), v.ty.push_back(t.y), v.tz.push_back(t.z), v.tw.push_back(1.0f);
        for (Column<float>* c : {&v.u0, &v.v0, &v.u1, &v.v1})
            c->push_back(0.0f);
        for (Column<float>* c : {&v.cr, &v.cg, &v.cb, &v.ca})
            c->push_back(1.0f);
    }
    scene.materials.push_back(material);
    scene.meshes.push_back({"thing", static_cast<std::uint32_t>(scene.primitives.size()), 1});
    scene.primitives.push_back(p);
    Node node;
    node.parent = parent, node.mesh = static_cast<int>(scene.meshes.size()) - 1, node.local = placed;
    scene.nodes.push_back(node);
    return static_cast<int>(scene.nodes.size()) - 1;
}

namespace {

void add_quad(std::vector<glm::vec3>& to, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d)
{
    to.insert(to.end(), {a, b, c, a, c, d});
}

} // namespace

std::vector<glm::vec3> box_corners()
{
    std::vector<glm::vec3> out;
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            const auto corner = [&](float a, float b) {
                glm::vec3 p;
                p[axis] = side, p[(axis + 1) % 3] = side * a, p[(axis + 2) % 3] = b;
                return p;
            };
            add_quad(out, corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1));
        }
    return out;
}

std::vector<glm::vec3> ball_corners(int rings)
{
    std::vector<glm::vec3> out;
    const auto at = [&](int ring, int sector) {
        const double theta = 3.14159265358979 * ring / rings, phi = 3.14159265358979 * sector / rings;
        return glm::vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
    };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < 2 * rings; ++s) {
            const glm::vec3 a = at(r, s), b = at(r + 1, s), c = at(r + 1, s + 1), d = at(r, s + 1);
            if (r + 1 < rings)
                out.insert(out.end(), {a, b, c});
            if (r > 0)
                out.insert(out.end(), {a, c, d});
        }
    return out;
}

std::vector<glm::vec3> plate_corners(int cells)
{
    std::vector<glm::vec3> out;
    const auto at = [&](int x, int y) {
        return glm::vec3(2.0f * static_cast<float>(x) / static_cast<float>(cells) - 1.0f,
                         2.0f * static_cast<float>(y) / static_cast<float>(cells) - 1.0f, 0.0f);
    };
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x)
            add_quad(out, at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
    return out;
}

std::vector<glm::vec3> turned_inside(std::vector<glm::vec3> corners)
{
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        std::swap(corners[i + 1], corners[i + 2]);
    return corners;
}

glm::mat4 random_placement(Dice& dice, float size, float distance)
{
    glm::mat4 m = glm::translate(glm::mat4(1.0f), dice.direction() * distance);
    m = glm::rotate(m, dice.between(0.0f, 6.28f), dice.direction());
    glm::vec3 scale(size * dice.between(0.3f, 1.0f), size * dice.between(0.3f, 1.0f), size * dice.between(0.3f, 1.0f));
    if (dice.below(4) == 0)
        scale.x = -scale.x;
    m = glm::scale(m, scale);
    return dice.below(3) == 0 ? glm::rotate(m, dice.between(0.0f, 6.28f), dice.direction()) : m; // sometimes skewed
}

Material unlit(const glm::vec3& color)
{
    Material m;
    m.unlit = true;
    m.base_color = glm::vec4(color, 1.0f);
    return m;
}

Result<Frame> draw_world(World world, const FrameDesc& desc, float radiance, const Road& road, Dice& dice)
{
    static const auto jobs = std::make_shared<const Jobs>(1);
    static std::map<float, std::shared_ptr<const Environment>> environments;
    std::shared_ptr<const Environment>& environment = environments[radiance];
    if (!environment) {
        Image image = make_image(16, 8, 3, PixelType::f32);
        std::fill_n(image.f32(), 16 * 8 * 3, radiance);
        EnvironmentOptions options;
        options.cube_size = 16, options.samples = 64, options.use_cache = false;
        Result<Environment> baked = bake_environment(image, "constant", options, *jobs);
        BN_TRY(baked);
        environment = std::make_shared<const Environment>(std::move(*baked));
    }
    update_world(world.scene);
    if (road.by_file) {
        const std::string text = gltf_of(world, dice);
        Result<Scene> read = load_gltf_bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), "world.gltf", {});
        BN_TRY(read);
        world.scene = std::move(*read);
    }
    Result<std::shared_ptr<const SceneData>> data = make_scene_data("world", std::move(world.scene), {});
    BN_TRY(data);
    SessionOptions options;
    options.backend = road.backend;
    options.reference.samples = 64;
    Result<Session> session = Session::make({*data, environment, jobs, {}}, options);
    BN_TRY(session);
    return session->render(desc);
}

} // namespace burnish::test
