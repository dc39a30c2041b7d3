// A slightly domed brass plate, brushed by a direction texture. Grooves run in circles on a disc, along rays in a
// sunburst, and crosswise in squares around both.
#include <cmath>

#include "core/math/scalar_math.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kPlateWidth = 0.3, kPlateHeight = 0.2, kThickness = 0.004, kDome = 0.006; // metres
constexpr int kGridColumns = 120, kGridRows = 80;
constexpr int kTextureWidth = 768, kTextureHeight = 512;
constexpr double kTilt = -0.25; // radians about +X: leans back

// Height of the front over the middle plane, and its slopes; x and y in [-1, 1].
struct Dome {
    double z, dz_dx, dz_dy; // metres, and metres per metre
};
Dome dome(double x, double y)
{
    const double a = 1.0 - x * x, b = 1.0 - y * y;
    return {0.5 * kThickness + kDome * a * b, kDome * -2.0 * x * b / (0.5 * kPlateWidth), kDome * -2.0 * y * a / (0.5 * kPlateHeight)};
}

void add_faces(Scene& scene)
{
    for (const double side : {1.0, -1.0}) // front, back
        add_grid(scene, kGridColumns, kGridRows, [side](int column, int row) {
            const double u = static_cast<double>(column) / kGridColumns, v = 1.0 - static_cast<double>(row) / kGridRows;
            const double x = side * (2.0 * u - 1.0), y = 1.0 - 2.0 * v;
            const Dome d = side > 0.0 ? dome(x, y) : Dome{-0.5 * kThickness, 0.0, 0.0};
            SurfacePoint s;
            s.position = {0.5 * kPlateWidth * x, 0.5 * kPlateHeight * y, d.z};
            s.normal = {-d.dz_dx, -d.dz_dy, side};
            s.tangent = {side, 0.0, side * d.dz_dx};
            s.u = u;
            s.v = v;
            return s;
        });
}

void add_edges(Scene& scene)
{
    const glm::dvec2 corners[5] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}};
    for (int edge = 0; edge < 4; ++edge) {
        const glm::dvec2 a = corners[edge], way = corners[edge + 1] - a;
        const int steps = edge % 2 ? kGridRows : kGridColumns;
        add_grid(scene, steps, 1, [&](int column, int row) {
            const double t = static_cast<double>(column) / steps;
            const glm::dvec2 at = a + way * t;
            SurfacePoint s;
            s.position = {0.5 * kPlateWidth * at.x, 0.5 * kPlateHeight * at.y, (row - 0.5) * kThickness};
            s.normal = {way.y, -way.x, 0.0};
            s.tangent = {way.x, way.y, 0.0};
            // The centre of a weave cell with grooves along the edge.
            s.u = 0.5;
            s.v = 0.09375;
            return s;
        });
    }
}

struct Grooves {
    double x, y, strength; // direction (any length, zero only at a centre), y up in the image
};
// Returns the grooves at x in [-1.5, 1.5], y in [-1, 1], y up.
Grooves grooves_at(double x, double y)
{
    const double disc_x = x + 0.6, disc = std::sqrt(disc_x * disc_x + y * y);
    if (disc < 0.75) // turned: along circles
        return {-y, disc_x, 1.0};
    const double burst_x = x - 0.85, burst = std::sqrt(burst_x * burst_x + y * y);
    if (burst < 0.5) // sunburst: along rays
        return {burst_x, y, 0.9};
    const int cell = static_cast<int>(std::floor(x * 8.0) + std::floor(y * 8.0));
    return cell & 1 ? Grooves{0.0, 1.0, 0.75} : Grooves{1.0, 0.0, 0.75};
}

Image make_direction_image()
{
    Image image = make_image(kTextureWidth, kTextureHeight, 3, PixelType::u8);
    const auto store = [](double v) { return static_cast<std::byte>(static_cast<int>(v * 255.0 + 0.5)); };
    std::size_t at = 0;
    for (int row = 0; row < kTextureHeight; ++row)
        for (int column = 0; column < kTextureWidth; ++column) {
            const double x = ((column + 0.5) / kTextureWidth * 2.0 - 1.0) * 1.5;
            const double y = 1.0 - (row + 0.5) / kTextureHeight * 2.0;
            const Grooves g = grooves_at(x, y);
            const double length = std::sqrt(g.x * g.x + g.y * g.y);
            image.bytes[at++] = store(0.5 - 0.5 * g.y / length); // the highlight's direction, across the grooves
            image.bytes[at++] = store(0.5 + 0.5 * g.x / length);
            image.bytes[at++] = store(g.strength);
        }
    return image;
}

} // namespace

Scene make_plate()
{
    Scene scene;
    scene.name = "plate";
    Texture clamped;
    clamped.wrap_s = clamped.wrap_t = WrapMode::clamp;
    add_texture(scene, "brushing", make_direction_image(), clamped);

    Material brass;
    brass.name = "brushed brass";
    brass.base_color = glm::vec4(0.91f, 0.78f, 0.42f, 1.0f);
    brass.roughness = 0.3f;
    brass.anisotropy_strength = 1.0f;
    brass.anisotropy_tex.texture = 0;
    scene.materials.push_back(brass);

    const std::uint32_t first = begin_primitive(scene, 0);
    add_faces(scene);
    add_edges(scene);
    const auto c = static_cast<float>(det_cos(kTilt)), s = static_cast<float>(det_sin(kTilt));
    glm::mat4 local(1.0f);
    local[1] = glm::vec4(0.0f, c, s, 0.0f);
    local[2] = glm::vec4(0.0f, -s, c, 0.0f);
    add_node(scene, "plate", add_mesh(scene, "plate", first), local);
    return scene;
}

} // namespace burnish
