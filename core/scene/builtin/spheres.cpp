// A wall of spheres: roughness grows to the right, eta upwards. Also one sphere under a lamp. Tangents point east.
#include <cmath>
#include <cstdio>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr int kColumns = 7, kRows = 5;            // spheres
constexpr double kRadius = 0.045, kSpacing = 0.1; // metres

} // namespace

void add_sphere(Scene& scene, int meridians, int parallels, double radius)
{
    add_grid(scene, meridians, parallels, [=](int column, int row) {
        const double longitude = 2.0 * kPi * (column % meridians) / meridians;
        const double latitude = kPi * (static_cast<double>(row) / parallels - 0.5);
        const double c = row == 0 || row == parallels ? 0.0 : det_cos(latitude); // exact at the poles
        const double east_x = det_cos(longitude), east_z = -det_sin(longitude);
        SurfacePoint s;
        s.normal = {c * -east_z, det_sin(latitude), c * east_x};
        s.position = s.normal * radius;
        s.tangent = {east_x, 0.0, east_z};
        s.u = static_cast<double>(column) / meridians;
        s.v = 1.0 - static_cast<double>(row) / parallels;
        return s;
    });
}

namespace {

constexpr double kEta[kRows] = {0.0, 0.25, 0.5, 0.75, 0.95};

// Converts the widths roughness^2 (1 +- eta) to KHR_materials_anisotropy: alpha across the tangent, mix(alpha, 1,
// strength^2) along it.
void set_widths(Material& material, double roughness, double eta)
{
    const double along = roughness * roughness * (1.0 + eta), across = roughness * roughness * (1.0 - eta);
    material.roughness = static_cast<float>(std::sqrt(across));
    material.anisotropy_strength = static_cast<float>(std::sqrt((along - across) / (1.0 - across)));
}

Material silver(double roughness, double eta)
{
    return brushed_metal(roughness, eta, glm::vec3(0.95f, 0.93f, 0.88f));
}

void add_front_camera(Scene& scene)
{
    Camera camera;
    camera.name = "front";
    camera.yfov = 0.35f;
    camera.znear = 0.1f;
    scene.cameras.push_back(camera);
    glm::mat4 local(1.0f);
    local[3][2] = 1.5f;
    Node node;
    node.name = camera.name;
    node.camera = 0;
    node.local = node.world = local;
    scene.nodes.push_back(node);
}

} // namespace

void add_part(Scene& scene, const Material& material, const glm::vec3& at, void (*add)(Scene&))
{
    scene.materials.push_back(material);
    const std::uint32_t first = begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size()) - 1);
    add(scene);
    glm::mat4 local(1.0f);
    local[3] = glm::vec4(at, 1.0f);
    add_node(scene, material.name.c_str(), add_mesh(scene, material.name.c_str(), first), local);
}

Material brushed_metal(double roughness, double eta, const glm::vec3& colour)
{
    Material material;
    set_widths(material, roughness, eta);
    material.base_color = glm::vec4(colour, 1.0f);
    return material;
}

Scene make_spheres()
{
    Scene scene;
    scene.name = "spheres";
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            Material material = silver((column + 1) * 0.1, kEta[row]);
            char name[64];
            std::snprintf(name, sizeof(name), "roughness 0.%d eta %.2f", column + 1, kEta[row]);
            material.name = name;
            scene.materials.push_back(material);

            // All spheres share the first sphere's vertices and indices.
            const std::uint32_t first = begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size() - 1));
            if (first == 0) {
                add_sphere(scene, 48, 24, kRadius);
            } else {
                scene.primitives[first] = scene.primitives[0];
                scene.primitives[first].material = static_cast<std::int32_t>(first);
            }
            glm::mat4 local(1.0f);
            local[3][0] = static_cast<float>((column - (kColumns - 1) * 0.5) * kSpacing);
            local[3][1] = static_cast<float>((row - (kRows - 1) * 0.5) * kSpacing);
            add_node(scene, name, add_mesh(scene, name, first), local);
        }
    add_front_camera(scene);
    return scene;
}

Scene make_sphere()
{
    Scene scene;
    scene.name = "sphere";
    scene.materials.push_back(silver(0.5, 0.6));
    const std::uint32_t first = begin_primitive(scene, 0);
    add_sphere(scene, 120, 60, 0.2);
    add_node(scene, "sphere", add_mesh(scene, "sphere", first), glm::mat4(1.0f));
    Light lamp;
    lamp.name = "lamp";
    lamp.type = LightType::directional;
    lamp.intensity = 1.0f; // lux
    scene.lights.push_back(lamp);
    Node node;
    node.name = lamp.name, node.light = 0;
    // emits along -Z, from above, right and front: rotated by 30 degrees about Y, then -40 about X
    const float cy = 0.8660254f, sy = 0.5f, cx = 0.7660444f, sx = 0.6427876f;
    node.local[0] = glm::vec4(cy, 0.0f, -sy, 0.0f);
    node.local[1] = glm::vec4(-sy * sx, cx, -cy * sx, 0.0f);
    node.local[2] = glm::vec4(sy * cx, sx, cy * cx, 0.0f);
    node.world = node.local;
    scene.nodes.push_back(node);
    add_front_camera(scene);
    return scene;
}

} // namespace burnish
