#include "bench/scenes/scenes.h"

#include <algorithm>
#include <cmath>

#include "bench/scenes/stress.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kRightAngle = 1.57079633f; // at distance 1, a sheet is visible from -1 to 1

Material brushed_metal()
{
    Material m;
    m.base_color = glm::vec4(0.9f, 0.85f, 0.8f, 1.0f);
    m.roughness = 0.3f;
    m.anisotropy_strength = 0.8f;
    return m;
}

Material constant_colour()
{
    Material m;
    m.base_color = glm::vec4(0.25f, 0.5f, 0.75f, 1.0f);
    m.unlit = true;
    return m;
}

// Adds a sheet of columns x rows quads at distance 1 - z, slightly larger than the image. `wave` is in metres.
void add_sheet(Scene& scene, int columns, int rows, double aspect, double z, double wave)
{
    const double half_y = 1.003 * (1.0 - z) + wave, half_x = half_y * aspect;
    add_grid(scene, columns, rows, [=](int column, int row) {
        const double u = static_cast<double>(column) / columns, v = static_cast<double>(row) / rows;
        const double x = (2.0 * u - 1.0) * half_x, y = (2.0 * v - 1.0) * half_y;
        SurfacePoint p;
        p.position = {x, y, z + wave * std::sin(9.0 * x + 4.0 * y)};
        p.normal = {0.0, 0.0, 1.0};
        p.tangent = {1.0, 0.0, 0.0};
        p.u = u, p.v = 1.0 - v;
        return p;
    });
}

void place(Scene& scene, const char* name)
{
    add_node(scene, name, add_mesh(scene, name, 0), glm::mat4(1.0f));
}

Scene make_waves(std::int64_t triangles, double aspect)
{
    Scene scene;
    scene.materials.push_back(constant_colour());
    begin_primitive(scene, 0);
    const double rows = std::sqrt(static_cast<double>(triangles) / (2.0 * aspect));
    add_sheet(scene, std::max(1, static_cast<int>(std::lround(rows * aspect))), std::max(1, static_cast<int>(std::lround(rows))), aspect,
              0.0, triangles > 2 ? 0.02 : 0.0);
    place(scene, "waves");
    return scene;
}

Scene make_layers(std::int64_t count, double aspect)
{
    Scene scene;
    scene.materials.push_back(brushed_metal());
    for (std::int64_t i = 0; i < count; ++i) { // the nearest sheet is equal for any number of sheets
        begin_primitive(scene, 0);
        add_sheet(scene, 64, 36, aspect, -0.1 * static_cast<double>(count - 1 - i), 0.0);
    }
    place(scene, "layers");
    return scene;
}

View sphere_view(int width, int height)
{
    return make_view({0.1f, 0.2f, 0.0f}, {1.0f, 0.1f, 0.3f}, 1.0f, width, height);
}

// Makes a patch in the middle of sphere_view(): an eighth of the pixels, so sqrt(1/8) of the width and of the height.
Scene make_eighth(double aspect)
{
    constexpr int kColumns = 64, kRows = 36;
    Scene scene;
    Material metal = brushed_metal();
    metal.double_sided = true;
    scene.materials.push_back(metal);
    begin_primitive(scene, 0);
    const View view = sphere_view(16, 9);
    const double high = std::tan(0.5) * std::sqrt(0.125);
    add_grid(scene, kColumns, kRows, [&](int column, int row) {
        const glm::dvec3 eye = view.eye;
        const double x = (2.0 * column / kColumns - 1.0) * high * aspect, y = (1.0 - 2.0 * row / kRows) * high;
        const glm::dvec3 ray = glm::normalize(glm::dvec3(view.forward) + x * glm::dvec3(view.right) + y * glm::dvec3(view.up));
        const double along = glm::dot(eye, ray);
        const glm::dvec3 at = eye + (std::sqrt(along * along + 1.0 - glm::dot(eye, eye)) - along) * ray;
        const double phi = std::atan2(at.z, at.x);
        SurfacePoint p;
        p.position = p.normal = {at.x, at.y, at.z};
        p.tangent = {-std::sin(phi), 0.0, std::cos(phi)};
        return p;
    });
    place(scene, "eighth");
    return scene;
}

Scene make_sphere()
{
    constexpr int kRings = 96, kSegments = 192;
    Scene scene;
    Material metal = brushed_metal();
    metal.double_sided = true;
    scene.materials.push_back(metal);
    begin_primitive(scene, 0);
    add_grid(scene, kSegments, kRings, [](int column, int row) {
        const double theta = kPi * row / kRings, phi = 2.0 * kPi * column / kSegments;
        SurfacePoint p;
        p.position = p.normal = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
        p.tangent = {-std::sin(phi), 0.0, std::cos(phi)};
        return p;
    });
    place(scene, "sphere");
    return scene;
}

Scene make_scene(BenchScene kind, std::int64_t size, double aspect)
{
    switch (kind) {
    case BenchScene::constant:
        return make_waves(2, aspect);
    case BenchScene::waves:
        return make_waves(size, aspect);
    case BenchScene::layers:
        return make_layers(size, aspect);
    case BenchScene::sphere:
        return make_sphere();
    case BenchScene::eighth:
        return make_eighth(aspect);
    case BenchScene::teapot:
        return make_teapot();
    case BenchScene::textured:
        return make_textured(size, aspect);
    case BenchScene::floor:
        return make_floor();
    case BenchScene::foliage:
    case BenchScene::leaves:
        return make_foliage(size, aspect, kind == BenchScene::leaves);
    case BenchScene::slivers:
        return make_slivers(size, aspect);
    case BenchScene::lit:
        return make_lit(size, aspect);
    case BenchScene::crowd:
        return make_crowd(size);
    case BenchScene::materials:
        return make_many_materials(size, aspect);
    }
    return {};
}

} // namespace

Scene make_bench_scene(BenchScene kind, std::int64_t size, int width, int height)
{
    const double aspect = static_cast<double>(width) / height;
    Scene scene = make_scene(kind, size, aspect);
    update_world(scene);
    return scene;
}

View bench_view(BenchScene kind, const DrawTables& tables, int width, int height)
{
    if (kind == BenchScene::teapot)
        return auto_frame(tables, width, height);
    if (kind == BenchScene::sphere || kind == BenchScene::eighth)
        return sphere_view(width, height);
    return make_view({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, kRightAngle, width, height);
}

} // namespace burnish
