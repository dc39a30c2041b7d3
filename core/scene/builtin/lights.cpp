// A dark room: brushed plates and spheres under strips, discs, a tube and a ball of light.
#include <cmath>
#include <cstdio>

#include "core/scene/area_light.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr double kHalfWidth = 1.8, kBack = -1.2, kFront = 1.6; // the floor, metres

// Adds a flat grid of squares from one corner along two sides, brushed along the first side. It faces the sides' cross
// product.
void add_panel(Scene& scene, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int squares)
{
    add_grid(scene, squares, squares, [=](int column, int row) {
        SurfacePoint s;
        s.u = static_cast<double>(column) / squares, s.v = 1.0 - static_cast<double>(row) / squares;
        s.position = corner + u * s.u + v * (1.0 - s.v);
        s.normal = glm::cross(u, v);
        s.tangent = u;
        return s;
    });
}

std::uint32_t begin_surface(Scene& scene, const Material& material)
{
    scene.materials.push_back(material);
    return begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size() - 1));
}

Material dull(const char* name, const glm::vec3& colour, float roughness)
{
    Material material;
    material.name = name;
    material.metallic = 0.0f, material.roughness = roughness;
    material.base_color = glm::vec4(colour, 1.0f);
    return material;
}

void add_room(Scene& scene)
{
    std::uint32_t first = begin_surface(scene, dull("floor", glm::vec3(0.05f, 0.05f, 0.06f), 0.35f));
    add_panel(scene, {-kHalfWidth, 0.0, kFront}, {2.0 * kHalfWidth, 0.0, 0.0}, {0.0, 0.0, kBack - kFront}, 24);
    add_node(scene, "floor", add_mesh(scene, "floor", first), glm::mat4(1.0f));
    first = begin_surface(scene, dull("wall", glm::vec3(0.16f, 0.15f, 0.14f), 0.7f));
    add_panel(scene, {-kHalfWidth, 0.0, kBack}, {2.0 * kHalfWidth, 0.0, 0.0}, {0.0, 1.8, 0.0}, 24);
    add_node(scene, "wall", add_mesh(scene, "wall", first), glm::mat4(1.0f));
}

// Adds plates that lean against the wall: brushed along, brushed across, and hardly brushed.
void add_plates(Scene& scene)
{
    constexpr double kPlateWidth = 0.72, kPlateHeight = 0.8, kLean = 0.3; // kLean: offset of the top, backwards
    struct Plate {
        const char* name;
        double x, roughness, eta;
        bool upright;
    };
    const Plate plates[] = {{"plate brushed along", -0.95, 0.45, 0.85, false},
                            {"plate brushed upwards", 0.0, 0.45, 0.85, true},
                            {"plate hardly brushed", 0.95, 0.35, 0.0, false}};
    for (const Plate& plate : plates) {
        Material material = brushed_metal(plate.roughness, plate.eta, glm::vec3(0.85f, 0.8f, 0.74f));
        material.name = plate.name;
        const std::uint32_t first = begin_surface(scene, material);
        const glm::dvec3 corner(plate.x - 0.5 * kPlateWidth, 0.0, -0.75), across(kPlateWidth, 0.0, 0.0), up(0.0, kPlateHeight, -kLean);
        if (plate.upright)
            add_panel(scene, corner + across, up, -across, 12);
        else
            add_panel(scene, corner, across, up, 12);
        add_node(scene, plate.name, add_mesh(scene, plate.name, first), glm::mat4(1.0f));
    }
}

void add_balls(Scene& scene)
{
    constexpr double kRadius = 0.13;
    for (int i = 0; i < 5; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "sphere %d", i);
        Material material = brushed_metal(0.15 + 0.13 * i, i % 2 ? 0.0 : 0.8, glm::vec3(0.95f, 0.93f, 0.88f));
        if (i == 3) // a painted one
            material = dull(name, glm::vec3(0.5f, 0.12f, 0.08f), 0.4f);
        material.name = name;
        const std::uint32_t first = begin_surface(scene, material);
        add_sphere(scene, 48, 24, kRadius);
        glm::mat4 local(1.0f);
        local[3] = glm::vec4(static_cast<float>(0.42 * (i - 2)), static_cast<float>(kRadius), 0.25f, 1.0f);
        add_node(scene, name, add_mesh(scene, name, first), local);
    }
}

void add_lights(Scene& scene)
{
    const auto light = [&](AreaShape shape, std::vector<glm::vec3> points, const glm::vec3& radiance, float radius) {
        AreaLight l;
        l.shape = shape, l.points = std::move(points), l.radiance = radiance, l.radius = radius;
        add_area_light(scene, l);
    };
    const glm::vec3 white(1.0f, 0.97f, 0.92f), warm(1.0f, 0.62f, 0.3f), cool(0.45f, 0.68f, 1.0f);
    // strips over the plates: one along them, one towards the eye
    light(AreaShape::quad, {{-1.5f, 1.45f, -0.35f}, {0.3f, 1.45f, -0.35f}, {0.3f, 1.47f, -0.25f}, {-1.5f, 1.47f, -0.25f}}, white * 14.0f,
          0.0f);
    light(AreaShape::quad, {{0.7f, 1.5f, -0.5f}, {0.8f, 1.5f, -0.5f}, {0.8f, 1.5f, 1.0f}, {0.7f, 1.5f, 1.0f}}, cool * 12.0f, 0.0f);
    light(AreaShape::disk, {{-1.45f, 1.2f, -1.19f}, {-1.25f, 1.2f, -1.19f}, {-1.45f, 1.4f, -1.19f}}, warm * 5.0f, 0.0f);
    light(AreaShape::disk, {{1.45f, 0.5f, -1.1f}, {1.6f, 0.5f, -0.95f}, {1.45f, 0.8f, -1.1f}}, cool * 4.0f, 0.0f);
    light(AreaShape::polygon,
          {{-1.7f, 0.1f, 0.1f}, {-1.5f, 0.1f, -0.2f}, {-1.46f, 0.45f, -0.26f}, {-1.6f, 0.7f, -0.05f}, {-1.74f, 0.4f, 0.16f}},
          glm::vec3(0.5f, 1.0f, 0.55f) * 3.0f, 0.0f);
    light(AreaShape::line, {{1.55f, 0.05f, 0.3f}, {1.55f, 0.95f, 0.3f}}, warm * 30.0f, 0.012f);
    light(AreaShape::sphere, {{0.21f, 0.34f, 0.62f}}, white * 10.0f, 0.05f);
}

void add_camera(Scene& scene)
{
    Camera camera;
    camera.name = "front";
    camera.yfov = 0.62f;
    camera.znear = 0.1f;
    scene.cameras.push_back(camera);
    const glm::dvec3 eye(0.0, 0.95, 3.3), back = glm::normalize(eye - glm::dvec3(0.0, 0.52, 0.0));
    const glm::dvec3 right(1.0, 0.0, 0.0), up = glm::cross(back, right);
    Node node;
    node.name = camera.name;
    node.camera = 0;
    node.local = glm::mat4(glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(up, 0.0), glm::dvec4(back, 0.0), glm::dvec4(eye, 1.0)));
    node.world = node.local;
    scene.nodes.push_back(node);
}

} // namespace

Scene make_lights()
{
    Scene scene;
    scene.name = "lights";
    add_room(scene);
    add_plates(scene);
    add_balls(scene);
    add_lights(scene);
    add_camera(scene);
    return scene;
}

} // namespace burnish
