// Surfaces defined by their maps: a hammered sphere, a disc brushed in circles, a record, a tiled wall.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kHalfSide = 0.45, kApart = 0.52; // metres: half size of all four objects; distance from the scene's centre
constexpr double kBackwards = -0.35;              // radians about +X: leans back

// Bowl-shaped dents around jittered grid points, which meet in ridges.
glm::dvec3 hammered(double u, double v)
{
    constexpr int kTurn = 26, kAcross = 13;
    constexpr double kDepth = 0.8;
    const double x = u * kTurn, y = v * kAcross;
    double nearest = 1e9;
    glm::dvec2 slope(0.0);
    for (int cy = static_cast<int>(y) - 1; cy <= static_cast<int>(y) + 1; ++cy)
        for (int cx = static_cast<int>(std::floor(x)) - 1; cx <= static_cast<int>(x) + 1; ++cx) {
            const int wrapped = (cx + kTurn) % kTurn;
            const glm::dvec2 to(x - (cx + 0.15 + 0.7 * noise(wrapped, cy, 1u)), y - (cy + 0.15 + 0.7 * noise(wrapped, cy, 2u)));
            const double squared = to.x * to.x + to.y * to.y;
            if (squared < nearest)
                nearest = squared, slope = {kDepth * to.x, -kDepth * to.y};
        }
    return normal_colour(slope);
}

// Converts to coordinates from the disc's centre, right and up.
glm::dvec2 on_disc(double u, double v)
{
    return {2.0 * u - 1.0, 1.0 - 2.0 * v};
}

glm::dvec3 circles(double u, double v) // encoded like KHR_materials_anisotropy
{
    const glm::dvec2 p = on_disc(u, v);
    const double r = std::max(std::sqrt(p.x * p.x + p.y * p.y), 1e-6);
    return {0.5 - 0.5 * p.y / r, 0.5 + 0.5 * p.x / r, 1.0};
}

constexpr double kLabel = 0.36, kGrooves = 0.42, kRim = 0.96;

glm::dvec3 grooves(double u, double v)
{
    const glm::dvec2 p = on_disc(u, v);
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    if (r < kGrooves || r > kRim)
        return normal_colour({0.0, 0.0});
    const double slope = 0.45 * det_sin(kTwoPi * 64.0 * r);
    return normal_colour(p * (slope / r));
}

glm::dvec3 record_colour(double u, double v)
{
    const glm::dvec2 p = on_disc(u, v);
    const double r2 = p.x * p.x + p.y * p.y;
    return r2 < kLabel * kLabel ? glm::dvec3(0.78, 0.22, 0.12) : glm::dvec3(0.13);
}

constexpr double kTiles = 5.0, kMortar = 0.03, kBevel = 0.09; // fractions of a tile: half the mortar; distance from edge to flat top

// A tile's height in [0,1], slope, and a flag for mortar. u and v run along the wall.
struct Tile {
    double height;
    glm::dvec2 slope;
    bool mortar;
    int column, row;
};
Tile tile_at(double u, double v)
{
    const double x = u * kTiles, y = v * kTiles;
    const glm::dvec2 in(x - std::floor(x), y - std::floor(y));
    const double from_x = std::min(in.x, 1.0 - in.x), from_y = std::min(in.y, 1.0 - in.y), edge = std::min(from_x, from_y);
    Tile tile = {std::clamp((edge - kMortar) / (kBevel - kMortar), 0.0, 1.0), glm::dvec2(0.0), edge < kMortar, static_cast<int>(x),
                 static_cast<int>(y)};
    if (!tile.mortar && edge < kBevel)
        tile.slope = from_x < from_y ? glm::dvec2(in.x < 0.5 ? 1.0 : -1.0, 0.0) : glm::dvec2(0.0, in.y < 0.5 ? -1.0 : 1.0);
    return tile;
}

glm::dvec3 tile_heights(double u, double v)
{
    return glm::dvec3(tile_at(u, v).height);
}

glm::dvec3 tiles(double u, double v)
{
    return normal_colour(tile_at(u, v).slope);
}

glm::dvec3 tile_colour(double u, double v)
{
    const Tile tile = tile_at(u, v);
    if (tile.mortar)
        return glm::dvec3(0.55);
    const double shade = noise(tile.column, tile.row, 3u);
    return {0.12 + 0.1 * shade, 0.34 + 0.15 * shade, 0.42 + 0.2 * shade};
}

// Adds a flat ring around the origin, facing +Z. Tangents point along +X; texture coordinates cover its square.
void add_flat_disc(Scene& scene)
{
    constexpr int kTurn = 96, kRings = 12;
    add_grid(scene, kTurn, kRings, [](int column, int row) {
        const double angle = kTwoPi * (column % kTurn) / kTurn, r = std::max(1.0 - static_cast<double>(row) / kRings, 0.02);
        const glm::dvec2 p(r * det_cos(angle), r * det_sin(angle));
        SurfacePoint s;
        s.position = {kHalfSide * p.x, kHalfSide * p.y, 0.0};
        s.normal = {0.0, 0.0, 1.0};
        s.tangent = {1.0, 0.0, 0.0};
        s.u = 0.5 + 0.5 * p.x, s.v = 0.5 - 0.5 * p.y;
        return s;
    });
}

void add_wall(Scene& scene)
{
    constexpr int kSquares = 16;
    add_grid(scene, kSquares, kSquares, [](int column, int row) {
        SurfacePoint s;
        s.u = static_cast<double>(column) / kSquares, s.v = 1.0 - static_cast<double>(row) / kSquares;
        s.position = {kHalfSide * (2.0 * s.u - 1.0), kHalfSide * (1.0 - 2.0 * s.v), 0.0};
        s.normal = {0.0, 0.0, 1.0};
        s.tangent = {1.0, 0.0, 0.0};
        return s;
    });
}

void place(Scene& scene, const char* name, std::uint32_t first, double x, double y, double lean)
{
    const auto c = static_cast<float>(det_cos(lean)), s = static_cast<float>(det_sin(lean));
    glm::mat4 local(1.0f);
    local[1] = glm::vec4(0.0f, c, s, 0.0f);
    local[2] = glm::vec4(0.0f, -s, c, 0.0f);
    local[3] = glm::vec4(static_cast<float>(x), static_cast<float>(y), 0.0f, 1.0f);
    add_node(scene, name, add_mesh(scene, name, first), local);
}

std::uint32_t begin(Scene& scene, const char* name, Material material)
{
    material.name = name;
    scene.materials.push_back(material);
    return begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size()) - 1);
}

} // namespace

Scene make_bumps()
{
    Scene scene;
    scene.name = "bumps";
    const std::int32_t directions = add_texture(scene, "circles", map_of(512, 512, circles));

    // Make the hammered sphere
    Material copper = brushed_metal(0.32, 0.6, {0.95f, 0.64f, 0.54f});
    copper.normal_tex.texture = add_texture(scene, "dents", map_of(1024, 512, hammered));
    std::uint32_t first = begin(scene, "hammered copper", copper);
    add_sphere(scene, 96, 48, kHalfSide);
    place(scene, "sphere", first, -kApart, kApart, 0.0);

    // Make the turned disc
    Material steel;
    steel.base_color = glm::vec4(0.77f, 0.78f, 0.78f, 1.0f);
    steel.roughness = 0.3f, steel.anisotropy_strength = 0.9f;
    steel.anisotropy_tex.texture = directions;
    first = begin(scene, "turned steel", steel);
    add_flat_disc(scene);
    place(scene, "disc", first, kApart, kApart, kBackwards);

    // Make the record
    Material vinyl;
    vinyl.metallic = 0.0f, vinyl.roughness = 0.3f, vinyl.anisotropy_strength = 0.5f;
    vinyl.anisotropy_tex.texture = directions;
    vinyl.base_color_tex.texture = add_texture(scene, "record", map_of(256, 256, record_colour));
    vinyl.normal_tex.texture = add_texture(scene, "grooves", map_of(1024, 1024, grooves));
    first = begin(scene, "vinyl", vinyl);
    add_flat_disc(scene);
    place(scene, "record", first, -kApart, -kApart, kBackwards);

    // Make the tiled wall
    Material glazed;
    glazed.metallic = 0.0f, glazed.roughness = 0.25f;
    glazed.base_color_tex.texture = add_texture(scene, "glaze", map_of(512, 512, tile_colour));
    glazed.normal_tex.texture = add_texture(scene, "bevels", map_of(512, 512, tiles));
    glazed.height_tex.texture = add_texture(scene, "heights", map_of(512, 512, tile_heights));
    glazed.height_scale = static_cast<float>((kBevel - kMortar) / kTiles); // bevels of 45 degrees, like their normals
    first = begin(scene, "tiles", glazed);
    add_wall(scene);
    place(scene, "wall", first, kApart, -kApart, kBackwards);
    return scene;
}

} // namespace burnish
