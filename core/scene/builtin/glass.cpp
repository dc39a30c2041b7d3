// Balls of clear, frosted and rough glass and a ring of brushed amber glass, on a turned steel disc under a lamp. All
// glass surfaces are closed, so that light that enters can leave.
#include <cmath>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr double kDiscRadius = 0.26, kDiscThickness = 0.008, kBallRadius = 0.056; // metres
constexpr double kRingRadius = 0.052, kRingThickness = 0.015;                     // radii of centre line and cross-section
constexpr int kAround = 96;

// Adds a surface of revolution about the y axis: columns go east, rows along the profile. at() returns a row's profile
// point and normal as (distance from the axis, height).
template <class Profile> void add_turned(Scene& scene, int rows, const Profile& at)
{
    add_grid(scene, kAround, rows, [&](int column, int row) {
        const double longitude = 2.0 * kPi * (column % kAround) / kAround, c = det_cos(longitude), s = det_sin(longitude);
        glm::dvec2 place, normal;
        at(row, place, normal);
        SurfacePoint p;
        p.position = {place.x * s, place.y, place.x * c};
        p.normal = {normal.x * s, normal.y, normal.x * c};
        p.tangent = {c, 0.0, -s};
        p.u = static_cast<double>(column) / kAround, p.v = 1.0 - static_cast<double>(row) / rows;
        return p;
    });
}

void add_disc(Scene& scene)
{
    const glm::dvec2 corners[] = {{0.0, -kDiscThickness}, {kDiscRadius, -kDiscThickness}, {kDiscRadius, 0.0}, {0.0, 0.0}};
    for (int side = 0; side < 3; ++side) { // bottom, rim, top
        const glm::dvec2 a = corners[side], way = corners[side + 1] - a;
        const int rows = side == 1 ? 1 : 12;
        add_turned(scene, rows, [&](int row, glm::dvec2& place, glm::dvec2& normal) {
            place = row == rows ? a + way : a + way * (static_cast<double>(row) / rows); // exact at both ends
            normal = {way.y, -way.x};
        });
    }
}

void add_ring(Scene& scene)
{
    constexpr int kAbout = 40;
    add_turned(scene, kAbout, [](int row, glm::dvec2& place, glm::dvec2& normal) {
        const double turn = 2.0 * kPi * (row % kAbout) / kAbout;
        normal = {det_cos(turn), det_sin(turn)};
        place = glm::dvec2(kRingRadius, 0.0) + normal * kRingThickness;
    });
}

Material glass(const char* name, float roughness, float strength, const glm::vec3& colour)
{
    Material material;
    material.name = name;
    material.metallic = 0.0f, material.transmission = 1.0f;
    material.roughness = roughness, material.anisotropy_strength = strength;
    material.base_color = glm::vec4(colour, 1.0f);
    return material;
}

template <class Add> void add_body(Scene& scene, const Material& material, const glm::vec3& at, const Add& add)
{
    scene.materials.push_back(material);
    const std::uint32_t first = begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size() - 1));
    add();
    glm::mat4 local(1.0f);
    local[3] = glm::vec4(at, 1.0f);
    add_node(scene, material.name.c_str(), add_mesh(scene, material.name.c_str(), first), local);
}

void add_lamp(Scene& scene)
{
    Light lamp;
    lamp.name = "lamp";
    lamp.type = LightType::directional;
    lamp.intensity = 0.15f; // lux
    scene.lights.push_back(lamp);
    Node node;
    node.name = lamp.name, node.light = 0;
    const glm::vec3 back = glm::normalize(glm::vec3(-0.55f, 0.75f, 0.35f)); // towards the lamp, which emits along -Z
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), back));
    node.local = glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f), glm::vec4(0, 0, 0, 1));
    node.world = node.local;
    scene.nodes.push_back(node);
}

void add_view_of_glass(Scene& scene)
{
    Camera camera;
    camera.name = "front";
    camera.yfov = 0.52f;
    camera.znear = 0.05f;
    scene.cameras.push_back(camera);
    const glm::vec3 eye(0.0f, 0.3f, 0.68f), back = glm::normalize(eye - glm::vec3(0.0f, 0.03f, 0.0f)), right(1.0f, 0.0f, 0.0f);
    Node node;
    node.name = camera.name, node.camera = 0;
    node.local = glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f), glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
    node.world = node.local;
    scene.nodes.push_back(node);
}

} // namespace

Scene make_glass()
{
    Scene scene;
    scene.name = "glass";
    Material steel = brushed_metal(0.35, 0.7, glm::vec3(0.42f, 0.43f, 0.45f));
    steel.name = "turned steel";
    add_body(scene, steel, glm::vec3(0.0f), [&] { add_disc(scene); });
    const auto ball = [&] { add_sphere(scene, 64, 32, kBallRadius); };
    const auto high = static_cast<float>(kBallRadius);
    const glm::vec3 clear(0.98f, 0.99f, 0.985f);
    add_body(scene, glass("clear", 0.0f, 0.0f, clear), {-0.14f, high, -0.02f}, ball);
    add_body(scene, glass("frosted", 0.25f, 0.0f, clear), {0.0f, high, -0.06f}, ball);
    add_body(scene, glass("rough", 0.5f, 0.0f, clear), {0.14f, high, -0.02f}, ball);
    add_body(scene, glass("brushed amber", 0.15f, 0.5f, {0.98f, 0.78f, 0.45f}), {0.0f, static_cast<float>(kRingThickness), 0.12f},
             [&] { add_ring(scene); });
    add_lamp(scene);
    add_view_of_glass(scene);
    return scene;
}

} // namespace burnish
