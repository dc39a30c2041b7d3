#include "core/scene/area_light.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "core/base/check.h"
#include "core/image/io/image_io.h"
#include "core/image/io/stored_colour.h"
#include "core/math/scalar_math.h"
#include "core/scene/grid.h"
#include "core/scene/tangents.h"

namespace burnish {
namespace {

using Points = std::vector<glm::dvec3>;

constexpr AreaShapeInfo kShapes[] = {
#define BN_AREA_SHAPE(name, at, least, most, what) {#name, least, most, what},
#include "core/scene/area_light.def"
};

bool is_polygon(AreaShape shape)
{
    return shape == AreaShape::quad || shape == AreaShape::polygon;
}

bool finite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Returns twice the polygon's area, as a vector along its normal.
glm::dvec3 double_area(const Points& p)
{
    glm::dvec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < p.size(); ++k)
        sum += glm::cross(p[k] - p[0], p[k + 1] - p[0]);
    return sum;
}

double extent_of(const Points& p)
{
    double most = 0.0;
    for (const glm::dvec3& q : p)
        most = std::max(most, glm::length(q - p[0]));
    return most;
}

std::string polygon_fault(const Points& p)
{
    const double extent = extent_of(p), least = 1e-6 * extent * extent;
    const glm::dvec3 area = double_area(p);
    if (!(glm::length(area) > least))
        return "its points lie on a line";
    const glm::dvec3 normal = glm::normalize(area);
    for (std::size_t k = 0; k < p.size(); ++k)
        if (std::fabs(glm::dot(p[k] - p[0], normal)) > 1e-3 * extent)
            return fmt::format("point {} does not lie in the plane of the others", k);
    for (std::size_t k = 0; k < p.size(); ++k) {
        const glm::dvec3 &before = p[(k + p.size() - 1) % p.size()], &after = p[(k + 1) % p.size()];
        if (glm::dot(glm::cross(p[k] - before, after - p[k]), normal) < -least)
            return fmt::format("it is concave at point {}", k);
    }
    for (std::size_t k = 1; k + 1 < p.size(); ++k) // a star polygon turns in one direction everywhere
        if (glm::dot(glm::cross(p[k] - p[0], p[k + 1] - p[0]), normal) < -least)
            return fmt::format("its edges cross at point {}", k);
    return "";
}

std::string texture_fault(AreaShape shape, const Points& p)
{
    if (shape != AreaShape::quad)
        return fmt::format("a {} has no texture, only a quad has one", area_shape_info(shape).name);
    if (glm::length(p[0] + p[2] - p[1] - p[3]) > 1e-3 * extent_of(p))
        return "a quad with a texture is a parallelogram, and its points are not";
    return "";
}

// Replaces two conjugate half axes u and v with orthogonal half axes that span the same ellipse with the same
// orientation. The longest radius is u cos t + v sin t with tan 2t = 2 u.v / (u.u - v.v).
void square_axes(glm::dvec3& u, glm::dvec3& v)
{
    const double difference = glm::dot(u, u) - glm::dot(v, v), mixed = 2.0 * glm::dot(u, v);
    if (std::fabs(mixed) <= 1e-9 * (glm::dot(u, u) + glm::dot(v, v)))
        return;
    const double root = std::sqrt(difference * difference + mixed * mixed), straight = std::fabs(difference) + root;
    glm::dvec2 turn = difference >= 0.0 ? glm::dvec2(straight, mixed) : glm::dvec2(mixed, straight);
    turn /= std::sqrt(turn.x * turn.x + turn.y * turn.y);
    const glm::dvec3 along = u * turn.x + v * turn.y, across = v * turn.x - u * turn.y;
    u = along, v = across;
}

} // namespace

const AreaShapeInfo& area_shape_info(AreaShape shape)
{
    static constexpr AreaShapeInfo kNoShape = {"light of no shape", 0, 0, "none"};
    return static_cast<int>(shape) < kAreaShapes ? kShapes[static_cast<std::size_t>(shape)] : kNoShape;
}

std::string area_light_fault(const AreaLight& light)
{
    // Check the shape and its number of points
    if (static_cast<int>(light.shape) >= kAreaShapes)
        return "its shape does not exist";
    const AreaShapeInfo& shape = area_shape_info(light.shape);
    const int count = static_cast<int>(light.points.size());
    if (count < shape.least || count > shape.most)
        return shape.least == shape.most
                   ? fmt::format("a {} has {} points ({}), {} are given", shape.name, shape.least, shape.what, count)
                   : fmt::format("a {} has {} to {} points ({}), {} are given", shape.name, shape.least, shape.most, shape.what, count);
    // Check that points and radiance are finite
    const Points p(light.points.begin(), light.points.end());
    for (int k = 0; k < count; ++k)
        if (!finite(p[static_cast<std::size_t>(k)]))
            return fmt::format("point {} is not finite", k);
    for (int c = 0; c < 3; ++c)
        if (!(light.radiance[c] >= 0.0f) || !std::isfinite(light.radiance[c]))
            return "its radiance is negative or not finite";
    // Check the radius, the ends and the texture
    const bool round = light.shape == AreaShape::sphere || light.shape == AreaShape::line;
    if (round && (!(light.radius > 0.0f) || !std::isfinite(light.radius)))
        return fmt::format("a {} needs a radius above 0", shape.name);
    if (light.shape == AreaShape::line && !(extent_of(p) > 0.0))
        return "its ends are one point";
    if (light.texture != kNone || !light.texture_file.empty())
        if (const std::string fault = texture_fault(light.shape, p); !fault.empty())
            return fault;
    // Check that flat shapes span an area
    if (is_polygon(light.shape))
        return polygon_fault(p);
    if (light.shape == AreaShape::disk && !(glm::length(double_area(p)) > 1e-6 * extent_of(p) * extent_of(p)))
        return "its points lie on a line";
    return "";
}

std::optional<PlacedAreaLight> place_area_light(const AreaLight& light, const glm::mat4& world)
{
    // Transform the points to world space
    const glm::dmat4 to(world);
    const glm::dmat3 linear(to);
    const bool mirrored = glm::determinant(linear) < 0.0;
    const double longest = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    Points p;
    for (const glm::vec3& point : light.points)
        p.emplace_back(to * glm::dvec4(glm::dvec3(point), 1.0));
    const bool flat = is_polygon(light.shape) || light.shape == AreaShape::disk;
    if (flat && mirrored) // the emitting side follows the node
        std::reverse(p.begin() + 1, p.end());
    // Copy the radiance and the texture, and scale the radius
    PlacedAreaLight placed;
    placed.shape = light.shape, placed.point_count = static_cast<int>(p.size());
    placed.radiance = light.radiance, placed.two_sided = light.two_sided;
    placed.texture = light.texture, placed.transposed = flat && mirrored;
    const double radius = longest * static_cast<double>(light.radius);
    placed.radius = static_cast<float>(radius);
    // Compute the area and the normal
    double area = 4.0 * kPi * radius * radius;
    if (light.shape == AreaShape::line)
        area = 2.0 * kPi * radius * glm::length(p[1] - p[0]);
    if (flat) {
        const glm::dvec3 twice = double_area(p);
        const double length = glm::length(twice), extent = extent_of(p);
        if (!(length > 1e-6 * extent * extent))
            return std::nullopt;
        area = light.shape == AreaShape::disk ? kPi * length : 0.5 * length;
        placed.normal = glm::vec3(twice / length);
    }
    // Make a disk's half axes orthogonal
    if (light.shape == AreaShape::disk) {
        p[1] -= p[0], p[2] -= p[0];
        square_axes(p[1], p[2]);
    }
    placed.area = static_cast<float>(area);
    for (std::size_t k = 0; k < p.size(); ++k)
        placed.points[k] = glm::vec3(p[k]);
    // Refuse lights that are not finite or have no area
    bool sound = std::isfinite(placed.radius) && std::isfinite(placed.area) && placed.area > 0.0f;
    for (const glm::vec3& point : placed.points)
        sound = sound && finite(glm::dvec3(point));
    return sound ? std::optional(placed) : std::nullopt;
}

Status read_area_texture(Scene& scene, AreaLight& light, const Limits& limits)
{
    if (light.texture_file.empty())
        return {};
    // Share the texture of an earlier light with this file
    for (const AreaLight& other : scene.area_lights)
        if (other.texture_file == light.texture_file) {
            light.texture = other.texture;
            return {};
        }
    light.texture = static_cast<std::int32_t>(scene.textures.size());
    // Read the image within the remaining texture limit
    Limits rest = limits;
    for (const Image& image : scene.images)
        rest.texture_bytes -= std::min<std::uint64_t>(rest.texture_bytes, image.bytes.size());
    PictureNotes notes;
    Result<Image> image = read_colours(light.texture_file, rest, notes);
    BN_TRY(image);
    for (const std::string& warning : notes.warnings)
        scene.warnings.push_back(light.texture_file + ": " + warning);
    if (const std::size_t clipped = clip_negative_colours(*image))
        scene.warnings.push_back(fmt::format("{}: {} texels of negative light are set to 0", light.texture_file, clipped));
    if (image->bytes.size() > rest.texture_bytes)
        return Error{ExitCode::bad_input, light.texture_file, "",
                     fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits.texture_bytes)};
    Texture texture;
    texture.name = light.texture_file;
    texture.image = static_cast<std::int32_t>(scene.images.size());
    texture.wrap_s = texture.wrap_t = WrapMode::clamp;
    scene.files.push_back(light.texture_file);
    scene.images.push_back(std::move(*image));
    scene.textures.push_back(texture);
    return {};
}

void add_area_light(Scene& scene, const AreaLight& light)
{
    Node node;
    node.name = area_shape_info(light.shape).name;
    node.area_light = static_cast<std::int32_t>(scene.area_lights.size());
    scene.area_lights.push_back(light);
    scene.nodes.push_back(node);
}

namespace {

constexpr int kAround = 64, kSphereRows = 32;

SurfacePoint point_at(const glm::dvec3& position, const glm::dvec3& normal)
{
    SurfacePoint s;
    s.position = position, s.normal = normal;
    s.tangent = glm::dvec3(any_tangent(glm::vec3(normal)));
    return s;
}

glm::dvec2 around(int step)
{
    const double angle = 2.0 * kPi * (step % kAround) / kAround;
    return {det_cos(angle), det_sin(angle)};
}

// Adds a polygon; a quad gets texture coordinates.
void add_polygon(Scene& scene, const PlacedAreaLight& light)
{
    const glm::dvec3 normal(light.normal);
    add_grid(scene, light.point_count - 2, 1, [&](int column, int row) {
        const int corner = row == 0 ? 0 : light.point_count - 1 - column;
        SurfacePoint p = point_at(glm::dvec3(light.points[corner]), normal);
        const double along = corner == 1 || corner == 2 ? 1.0 : 0.0, up = corner >= 2 ? 1.0 : 0.0;
        p.u = light.transposed ? up : along, p.v = 1.0 - (light.transposed ? along : up);
        return p;
    });
}

void add_disk(Scene& scene, const PlacedAreaLight& light)
{
    const glm::dvec3 centre(light.points[0]), u(light.points[1]), v(light.points[2]), normal(light.normal);
    add_grid(scene, kAround, 1, [&](int column, int row) {
        const glm::dvec2 at = around(kAround - column) * static_cast<double>(row);
        return point_at(centre + u * at.x + v * at.y, normal);
    });
}

void add_ball(Scene& scene, const PlacedAreaLight& light)
{
    add_grid(scene, kAround, kSphereRows, [&](int column, int row) {
        const double latitude = kPi * (static_cast<double>(row) / kSphereRows - 0.5);
        const double c = row == 0 || row == kSphereRows ? 0.0 : det_cos(latitude);
        const glm::dvec2 at = around(column);
        const glm::dvec3 normal(c * at.y, det_sin(latitude), c * at.x);
        return point_at(glm::dvec3(light.points[0]) + normal * static_cast<double>(light.radius), normal);
    });
}

void add_tube(Scene& scene, const PlacedAreaLight& light)
{
    const glm::dvec3 from(light.points[0]), to(light.points[1]), along = glm::normalize(to - from);
    const glm::dvec3 u = glm::normalize(glm::dvec3(any_tangent(glm::vec3(along)))), v = glm::cross(along, u);
    add_grid(scene, kAround, 1, [&](int column, int row) {
        const glm::dvec2 at = around(column);
        const glm::dvec3 normal = u * at.x + v * at.y;
        return point_at((row == 0 ? from : to) + normal * static_cast<double>(light.radius), normal);
    });
}

void add_emitter(Scene& scene, const PlacedAreaLight& light, int emitter)
{
    Material material;
    material.name = "light";
    material.unlit = true, material.emitter = emitter;
    material.base_color = glm::vec4(light.radiance, 1.0f);
    material.base_color_tex.texture = light.texture;
    material.double_sided = light.two_sided && light.normal != glm::vec3(0.0f);
    scene.materials.push_back(material);
    const std::uint32_t first = begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size() - 1));
    if (light.shape == AreaShape::disk)
        add_disk(scene, light);
    else if (light.shape == AreaShape::sphere)
        add_ball(scene, light);
    else if (light.shape == AreaShape::line)
        add_tube(scene, light);
    else
        add_polygon(scene, light);
    glm::mat4 place(1.0f);
    place[3] = glm::vec4(glm::vec3(scene.origin), 1.0f); // the corners are already in drawing coordinates
    add_node(scene, "light", add_mesh(scene, "light", first), place);
}

} // namespace

Status add_emitters(Scene& scene, int most_lights, const std::string& file)
{
    std::vector<PlacedAreaLight> lights;
    std::vector<int> emitters; // emitter materials
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.area_light == kNone)
            continue;
        if (node.area_light < 0 || static_cast<std::size_t>(node.area_light) >= scene.area_lights.size())
            return Error{ExitCode::bad_input, file, fmt::format("/nodes/{}/area_light", i),
                         fmt::format("area light {} does not exist", node.area_light)};
        const AreaLight& light = scene.area_lights[static_cast<std::size_t>(node.area_light)];
        if (const std::string fault = area_light_fault(light); !fault.empty())
            return Error{ExitCode::bad_input, file, fmt::format("area light {}", node.area_light), fault};
        if (const std::optional<PlacedAreaLight> placed = place_area_light(light, node.world)) {
            emitters.push_back(light.solid ? kSolidEmitter + static_cast<int>(lights.size()) : kOpenEmitter);
            lights.push_back(*placed);
        }
    }
    if (lights.size() > static_cast<std::size_t>(most_lights))
        return Error{ExitCode::bad_input, file, "",
                     fmt::format("the scene has {} area lights, more than {} (Limits::area_lights)", lights.size(), most_lights)};
    for (std::size_t i = 0; i < lights.size(); ++i)
        add_emitter(scene, lights[i], emitters[i]);
    return {};
}

} // namespace burnish
