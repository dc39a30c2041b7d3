// Clear coats: balls of carbon under smooth lacquer, car paint, and brushed steel under worn varnish, on a satin
// plastic disc under a lamp. The weave's threads are round but the lacquer is flat: its mirror reflection lies over the
// threads' blurred one.
#include <cmath>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kBall = 0.06, kFloor = 0.28; // radii in metres
constexpr int kWeave = 4;                     // threads in one period of the twill, in both directions

// A 2/2 twill: `along_u` where the thread along u is on top; `across` is the position between the thread's edges,
// [-1,1].
struct Thread {
    bool along_u;
    double across;
};
Thread thread_at(double u, double v)
{
    const double x = u * kWeave, y = v * kWeave;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const bool along_u = (column + row) % kWeave < kWeave / 2;
    const double in = along_u ? y - row : x - column;
    return {along_u, 2.0 * in - 1.0};
}

// Threads scatter light across themselves. Encoded like KHR_materials_anisotropy directions, strength in B.
glm::dvec3 weave_directions(double u, double v)
{
    return thread_at(u, v).along_u ? glm::dvec3(0.5, 1.0, 1.0) : glm::dvec3(1.0, 0.5, 1.0);
}

glm::dvec3 weave_normals(double u, double v)
{
    const Thread t = thread_at(u, v);
    const double slope = -0.35 * t.across; // v points down, the bitangent up
    return normal_colour(t.along_u ? glm::dvec2(0.0, -slope) : glm::dvec2(slope, 0.0));
}

void add_lacquer_floor(Scene& scene)
{
    constexpr int kTurn = 96, kRings = 12;
    add_grid(scene, kTurn, kRings, [](int column, int row) {
        const double angle = 2.0 * kPi * (column % kTurn) / kTurn, r = kFloor * (1.0 - static_cast<double>(row) / kRings);
        SurfacePoint s;
        s.position = {r * det_sin(angle), 0.0, r * det_cos(angle)};
        s.normal = {0.0, 1.0, 0.0};
        s.tangent = {1.0, 0.0, 0.0};
        s.u = 0.5 + 0.5 * s.position.x / kFloor, s.v = 0.5 + 0.5 * s.position.z / kFloor;
        return s;
    });
}

Material coated(const char* name, Material below, float coat_roughness)
{
    below.name = name;
    below.clearcoat = 1.0f, below.clearcoat_roughness = coat_roughness;
    return below;
}

Material carbon(Scene& scene)
{
    Material m;
    m.base_color = glm::vec4(0.16f, 0.165f, 0.17f, 1.0f);
    m.roughness = 0.32f, m.anisotropy_strength = 0.75f;
    const glm::mat3x2 repeats(12.0f, 0.0f, 0.0f, 6.0f, 0.0f, 0.0f);
    m.anisotropy_tex.texture = add_texture(scene, "twill, directions", map_of(64, 64, weave_directions));
    m.normal_tex.texture = add_texture(scene, "twill, normals", map_of(64, 64, weave_normals));
    m.anisotropy_tex.uv_transform = m.normal_tex.uv_transform = repeats;
    return coated("carbon under lacquer", m, 0.0f);
}

Material car_paint()
{
    Material m;
    m.base_color = glm::vec4(0.5f, 0.012f, 0.018f, 1.0f);
    m.metallic = 0.7f, m.roughness = 0.5f;
    return coated("car paint", m, 0.03f);
}

} // namespace

Scene make_lacquer()
{
    Scene scene;
    scene.name = "lacquer";
    Material plastic;
    plastic.name = "satin plastic";
    plastic.base_color = glm::vec4(0.06f, 0.065f, 0.075f, 1.0f);
    plastic.metallic = 0.0f, plastic.roughness = 0.4f;
    add_part(scene, plastic, glm::vec3(0.0f), add_lacquer_floor);
    const auto ball = [](Scene& s) { add_sphere(s, 96, 48, kBall); };
    const auto high = static_cast<float>(kBall);
    add_part(scene, carbon(scene), {-0.14f, high, 0.0f}, ball);
    add_part(scene, car_paint(), {0.0f, high, 0.0f}, ball);
    const Material steel = brushed_metal(0.35, 0.8, glm::vec3(0.56f, 0.57f, 0.58f));
    add_part(scene, coated("steel under varnish", steel, 0.35f), {0.14f, high, 0.0f}, ball);
    Light lamp;
    lamp.name = "lamp", lamp.type = LightType::directional, lamp.intensity = 0.5f; // lux
    scene.lights.push_back(lamp);
    Node shining = looking("lamp", glm::vec3(-0.5f, 0.9f, 0.7f), glm::vec3(0.0f));
    shining.light = 0;
    scene.nodes.push_back(shining);
    Camera camera;
    camera.name = "front", camera.yfov = 0.34f, camera.znear = 0.05f;
    scene.cameras.push_back(camera);
    Node view = looking("front", glm::vec3(0.0f, 0.22f, 0.72f), glm::vec3(0.0f, 0.05f, 0.0f));
    view.camera = 0;
    scene.nodes.push_back(view);
    return scene;
}

} // namespace burnish
