// Balls for judging mip filters: four materials defined by their maps. Each repeats its maps once, four and sixteen
// times around a ball. They stand on a knurled floor, with cameras near, far and along the floor. Maps repeat without a
// seam.
#include <array>
#include <cmath>
#include <string>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kShaderballRadius = 0.1, kBallsApart = 0.26, kGround = 0.9; // metres; kGround: half the floor's side
constexpr int kMapSide = 512;
constexpr int kTimes[] = {1, 4, 16};

double part_of(double x)
{
    return x - std::floor(x);
}

// Diamond pyramids: four slopes, and none at their mean, so that distant lobes are cross-shaped.
glm::dvec3 knurl_normals(double u, double v)
{
    constexpr double kDiamonds = 24.0, kSlope = 0.42;
    const double a = part_of((u + v) * kDiamonds) - 0.5, b = part_of((u - v) * kDiamonds) - 0.5;
    const double sa = a < 0.0 ? kSlope : -kSlope, sb = b < 0.0 ? kSlope : -kSlope;
    return normal_colour({0.5 * (sa + sb), -0.5 * (sa - sb)}); // v points down, the bitangent up
}

// Scratches along u, each in its own row, with random length and depth in [0,1].
struct Scratch {
    double depth, across; // across: [-1,1]
};
Scratch scratch_at(double u, double v)
{
    constexpr int kRows = 170, kPieces = 3;
    const int row = static_cast<int>(v * kRows) % kRows;
    const double along = part_of(u + noise(row, 0, 11u)) * kPieces;
    const int piece = static_cast<int>(along);
    const double length = 0.9 * noise(row, piece, 12u), depth = noise(row, piece, 13u);
    return {along - piece < length ? depth * depth : 0.0, 2.0 * part_of(v * kRows) - 1.0};
}
glm::dvec3 scratch_normals(double u, double v)
{
    const Scratch s = scratch_at(u, v);
    return normal_colour({0.0, -0.9 * s.depth * s.across});
}
glm::dvec3 scratch_roughness(double u, double v)
{
    return {1.0, 0.22 + 0.3 * scratch_at(u, v).depth, 1.0};
}

// A plain weave: `along_u` where the yarn along u is on top; `across` is the position between the yarn's edges, [-1,1].
struct Yarn {
    bool along_u;
    double across;
};
Yarn yarn_at(double u, double v)
{
    constexpr double kYarns = 32.0;
    const double x = part_of(u * kYarns), y = part_of(v * kYarns);
    const bool along_u = (static_cast<int>(u * kYarns) + static_cast<int>(v * kYarns)) % 2 == 0;
    return {along_u, 2.0 * (along_u ? y : x) - 1.0};
}
glm::dvec3 yarn_normals(double u, double v)
{
    const Yarn y = yarn_at(u, v);
    return normal_colour(y.along_u ? glm::dvec2(0.0, 0.5 * y.across) : glm::dvec2(-0.5 * y.across, 0.0));
}
glm::dvec3 yarn_directions(double u, double v) // encoded like KHR_materials_anisotropy: a yarn scatters across itself
{
    return yarn_at(u, v).along_u ? glm::dvec3(0.5, 1.0, 1.0) : glm::dvec3(1.0, 0.5, 1.0);
}
glm::dvec3 yarn_colour(double u, double v)
{
    return yarn_at(u, v).along_u ? glm::dvec3(0.62, 0.16, 0.13) : glm::dvec3(0.14, 0.2, 0.5);
}

// Ridges along v with flat tops of one colour and steep sides of another: their appearance from afar is not the mean of
// the maps.
double ridge_slope(double u)
{
    constexpr double kRidges = 20.0, kSteep = 1.2;
    const double x = part_of(u * kRidges);
    return x < 0.5 ? 0.0 : x < 0.75 ? -kSteep : kSteep;
}
glm::dvec3 ridge_normals(double u, double)
{
    return normal_colour({ridge_slope(u), 0.0});
}
glm::dvec3 ridge_colour(double u, double)
{
    return ridge_slope(u) == 0.0 ? glm::dvec3(0.98, 0.86, 0.5) : glm::dvec3(0.25, 0.5, 0.95);
}

std::int32_t square_map(Scene& scene, const char* name, glm::dvec3 (*colour)(double u, double v))
{
    return add_texture(scene, name, map_of(kMapSide, kMapSide, colour));
}

std::array<Material, 4> ball_materials(Scene& scene)
{
    std::array<Material, 4> all;
    auto& [brass, steel, silk, paint] = all;
    brass.name = "knurled brass";
    brass.base_color = glm::vec4(0.91f, 0.78f, 0.42f, 1.0f), brass.roughness = 0.28f;
    brass.normal_tex.texture = square_map(scene, "knurl", knurl_normals);
    steel.name = "scratched steel";
    steel.base_color = glm::vec4(0.68f, 0.69f, 0.7f, 1.0f);
    steel.normal_tex.texture = square_map(scene, "scratches", scratch_normals);
    steel.metallic_roughness_tex.texture = square_map(scene, "wear", scratch_roughness);
    silk.name = "shot silk";
    silk.metallic = 0.0f, silk.roughness = 0.38f, silk.anisotropy_strength = 0.7f, silk.ior = 1.8f;
    silk.base_color_tex.texture = square_map(scene, "yarns", yarn_colour);
    silk.normal_tex.texture = square_map(scene, "weave", yarn_normals);
    silk.anisotropy_tex.texture = square_map(scene, "ways", yarn_directions);
    paint.name = "ridged foil";
    paint.roughness = 0.35f;
    paint.base_color_tex.texture = square_map(scene, "two colours", ridge_colour);
    paint.normal_tex.texture = square_map(scene, "ridges", ridge_normals);
    return all;
}

// Repeats a material's maps `times` as often around a ball. The ball's texture coordinates are twice as wide as high.
Material repeated(Material m, int times)
{
    const auto n = static_cast<float>(times);
    for (TextureRef Material::*ref :
         {&Material::base_color_tex, &Material::normal_tex, &Material::metallic_roughness_tex, &Material::anisotropy_tex})
        (m.*ref).uv_transform = glm::mat3x2(2.0f * n, 0.0f, 0.0f, n, 0.0f, 0.0f);
    m.name += " x" + std::to_string(times);
    return m;
}

void add_ground(Scene& scene)
{
    constexpr int kSquares = 24, kRepeats = 24;
    add_grid(scene, kSquares, kSquares, [](int column, int row) {
        const double x = static_cast<double>(column) / kSquares, z = 1.0 - static_cast<double>(row) / kSquares;
        SurfacePoint s;
        s.position = {kGround * (2.0 * x - 1.0), 0.0, kGround * (2.0 * z - 1.0)};
        s.normal = {0.0, 1.0, 0.0};
        s.tangent = {1.0, 0.0, 0.0};
        s.u = kRepeats * x, s.v = kRepeats * z;
        return s;
    });
}

void add_viewer(Scene& scene, const char* name, const glm::vec3& eye, const glm::vec3& target)
{
    Camera camera;
    camera.name = name, camera.yfov = 0.5f, camera.znear = 0.02f;
    Node node = looking(name, eye, target);
    node.camera = static_cast<std::int32_t>(scene.cameras.size());
    scene.cameras.push_back(camera);
    scene.nodes.push_back(node);
}

} // namespace

Scene make_shaderballs()
{
    Scene scene;
    scene.name = "shaderballs";
    // Make the materials and the floor
    const std::array<Material, 4> materials = ball_materials(scene);
    Material rubber;
    rubber.name = "knurled rubber", rubber.metallic = 0.0f, rubber.roughness = 0.3f;
    rubber.base_color = glm::vec4(0.05f, 0.05f, 0.055f, 1.0f);
    rubber.normal_tex.texture = materials[0].normal_tex.texture;
    scene.materials.push_back(rubber);
    const std::uint32_t ground = begin_primitive(scene, 0);
    add_ground(scene);
    add_node(scene, "ground", add_mesh(scene, "ground", ground), glm::mat4(1.0f));
    // Place the balls: a row for each material, a column for each repetition
    std::uint32_t ball = 0; // all balls share the first ball's vertices and indices
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) {
            scene.materials.push_back(repeated(materials[static_cast<std::size_t>(row)], kTimes[column]));
            const auto material = static_cast<std::int32_t>(scene.materials.size()) - 1;
            const std::uint32_t first = begin_primitive(scene, material);
            if (ball == 0) {
                ball = first;
                add_sphere(scene, 64, 32, kShaderballRadius);
            } else {
                scene.primitives[first] = scene.primitives[ball];
                scene.primitives[first].material = material;
            }
            glm::mat4 local(1.0f);
            local[3] = glm::vec4(static_cast<float>((column - 1) * kBallsApart), static_cast<float>(kShaderballRadius),
                                 static_cast<float>((1.5 - row) * kBallsApart), 1.0f);
            const char* name = scene.materials.back().name.c_str();
            add_node(scene, name, add_mesh(scene, name, first), local);
        }
    // Add the lamp and the cameras
    Light lamp;
    lamp.name = "lamp", lamp.type = LightType::directional, lamp.intensity = 0.8f; // lux
    scene.lights.push_back(lamp);
    Node shining = looking("lamp", glm::vec3(-0.5f, 0.9f, 0.6f), glm::vec3(0.0f));
    shining.light = 0;
    scene.nodes.push_back(shining);
    add_viewer(scene, "near", glm::vec3(0.0f, 0.75f, 1.5f), glm::vec3(0.0f, 0.03f, 0.0f));
    add_viewer(scene, "mid", glm::vec3(0.0f, 2.0f, 4.0f), glm::vec3(0.0f, 0.03f, 0.0f));
    add_viewer(scene, "far", glm::vec3(0.0f, 6.0f, 12.0f), glm::vec3(0.0f, 0.03f, 0.0f));
    add_viewer(scene, "grazing", glm::vec3(0.13f, 0.045f, 1.1f), glm::vec3(0.13f, 0.045f, 0.0f));
    return scene;
}

} // namespace burnish
