#include "core/scene/draw_tables.h"

#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/jobs/control.h"
#include "core/math/scalar_math.h"
#include "core/scene/draw_clusters.h"
#include "core/scene/tangents.h"

namespace burnish {
namespace {

// Limit on vertex and triangle ids, which are 32-bit. 2^31 ids already exceed any sensible memory for the tables.
constexpr std::uint64_t kMaxIds = 1ull << 31;

// World placement of a node's geometry. Normals use the cofactor matrix: the inverse transpose times the determinant.
// This matrix exists even where a scale is 0 (a solid pressed flat).
struct Placement {
    glm::dmat4 world{1.0};
    glm::dmat3 linear{1.0}, cofactor{1.0};
    bool mirrored = false;
    bool usable = false; // finite, and some triangle could have an area
};

bool finite(double v)
{
    return std::fabs(v) <= std::numeric_limits<double>::max();
}
bool finite_f(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Placement make_placement(const glm::mat4& world)
{
    Placement p;
    p.world = glm::dmat4(world);
    p.linear = glm::dmat3(p.world);
    const glm::dvec3 a = p.linear[0], b = p.linear[1], c = p.linear[2];
    const glm::dmat3 cofactor(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
    p.mirrored = glm::dot(a, cofactor[0]) < 0.0;
    p.cofactor = p.mirrored ? -cofactor : cofactor;
    double sum = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            sum += std::fabs(p.world[column][row]);
    double area = 0.0;
    for (int column = 0; column < 3; ++column)
        area += glm::dot(cofactor[column], cofactor[column]);
    p.usable = finite(sum) && finite(area) && area > 0.0;
    return p;
}

// Returns the unit direction, or `otherwise` where v has no direction.
glm::dvec3 direction_or(const glm::dvec3& v, const glm::dvec3& otherwise)
{
    const double largest = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
    if (!(largest > 0.0) || !finite(largest))
        return otherwise;
    const glm::dvec3 scaled = v / largest; // avoids underflow and overflow in the square
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

ShadingVertex place_shading(const VertexTable& v, std::size_t i, const Placement& place)
{
    const glm::dvec3 n = direction_or(place.cofactor * glm::dvec3(v.nx[i], v.ny[i], v.nz[i]), glm::dvec3(0.0, 0.0, 1.0));
    const glm::dvec3 moved = direction_or(place.linear * glm::dvec3(v.tx[i], v.ty[i], v.tz[i]), glm::dvec3(0.0));
    glm::dvec3 t = moved - n * glm::dot(n, moved);
    if (!(glm::dot(t, t) > 1e-12)) // parallel to the normal, or zero
        t = glm::dvec3(any_tangent(glm::vec3(n)));
    t = direction_or(t - n * glm::dot(n, t), t);
    const bool negative = (v.tw[i] < 0.0f) != place.mirrored;

    ShadingVertex s{};
    for (int k = 0; k < 3; ++k) {
        s.normal[k] = static_cast<float>(n[k]);
        s.tangent[k] = static_cast<float>(t[k]);
    }
    s.tangent[3] = negative ? -1.0f : 1.0f;
    s.uv0[0] = v.u0[i];
    s.uv0[1] = v.v0[i];
    s.uv1[0] = v.u1[i];
    s.uv1[1] = v.v1[i];
    s.color[0] = v.cr[i];
    s.color[1] = v.cg[i];
    s.color[2] = v.cb[i];
    s.color[3] = v.ca[i];
    return s;
}

// Appends a primitive's vertices. Returns false and leaves the tables unchanged where a position leaves the range of
// floats.
bool append_vertices(const VertexTable& v, const Primitive& primitive, const Placement& place, DrawTables& out)
{
    const std::size_t base = out.px.size(), count = primitive.vertex_count;
    const auto resize = [&](std::size_t n) {
        for (Column<float>* column : {&out.px, &out.py, &out.pz})
            column->resize_for_overwrite(n);
    };
    resize(base + count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = primitive.first_vertex + k;
        const glm::vec3 p(glm::dvec3(place.world * glm::dvec4(v.px[i], v.py[i], v.pz[i], 1.0)));
        if (!finite_f(p)) {
            resize(base);
            return false;
        }
        out.px[base + k] = p.x;
        out.py[base + k] = p.y;
        out.pz[base + k] = p.z;
    }
    out.shading.resize_for_overwrite(base + count);
    for (std::size_t k = 0; k < count; ++k)
        out.shading[base + k] = place_shading(v, primitive.first_vertex + k, place);
    return true;
}

void append_triangles(const Scene& scene, const Primitive& primitive, bool mirrored, Draw& draw, DrawTables& out)
{
    const std::size_t base = out.indices.size(), base_triangle = base / 3;
    out.indices.resize_for_overwrite(base + primitive.index_count);
    out.triangle_material.resize_for_overwrite(base_triangle + draw.triangle_count);
    draw.bounds_min = glm::vec3(std::numeric_limits<float>::max());
    draw.bounds_max = -draw.bounds_min;
    for (std::size_t t = 0; t < draw.triangle_count; ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t from = mirrored ? (3 - corner) % 3 : corner;
            const std::uint32_t index = scene.indices[primitive.first_index + 3 * t + from];
            BN_CHECK_OP(index, >=, primitive.first_vertex);
            BN_CHECK_OP(index - primitive.first_vertex, <, primitive.vertex_count);
            const std::uint32_t moved = index - primitive.first_vertex + draw.first_vertex;
            out.indices[base + 3 * t + corner] = moved;
            const glm::vec3 p(out.px[moved], out.py[moved], out.pz[moved]);
            draw.bounds_min = glm::min(draw.bounds_min, p);
            draw.bounds_max = glm::max(draw.bounds_max, p);
        }
        out.triangle_material[base_triangle + t] = static_cast<std::uint32_t>(primitive.material);
    }
}

void append_draw(const Scene& scene, std::uint32_t primitive_id, std::int32_t node, const Placement& place, DrawTables& out)
{
    const Primitive& primitive = scene.primitives[primitive_id];
    BN_CHECK_OP(primitive.index_count % 3, ==, 0u);
    BN_CHECK_OP(std::uint64_t{primitive.first_index} + primitive.index_count, <=, scene.indices.size());
    BN_CHECK_OP(std::uint64_t{primitive.first_vertex} + primitive.vertex_count, <=, scene.vertices.size());
    BN_CHECK_OP(primitive.material, >=, 0);
    BN_CHECK_OP(static_cast<std::size_t>(primitive.material), <, scene.materials.size());
    BN_CHECK_OP(std::uint64_t{out.px.size()} + primitive.vertex_count, <=, kMaxIds);
    BN_CHECK_OP(std::uint64_t{out.indices.size()} + primitive.index_count, <=, kMaxIds);
    if (primitive.index_count == 0)
        return;

    Draw draw;
    draw.first_vertex = static_cast<std::uint32_t>(out.px.size());
    draw.vertex_count = primitive.vertex_count;
    draw.first_triangle = static_cast<std::uint32_t>(out.triangle_count());
    draw.triangle_count = primitive.index_count / 3;
    draw.material = primitive.material;
    draw.node = node, draw.primitive = primitive_id;
    draw.stage = scene.nodes[static_cast<std::size_t>(node)].stage;
    if (!append_vertices(scene.vertices, primitive, place, out))
        return;
    append_triangles(scene, primitive, place.mirrored, draw, out);
    const auto id = static_cast<std::uint32_t>(out.draws.size());
    out.draws.push_back(draw);
    append_clusters(out, id, scene.materials[static_cast<std::size_t>(draw.material)].double_sided);
}

// Appends a light, unless its node gives a place or direction that is not finite.
void append_light(const Light& light, const glm::mat4& world, std::vector<PunctualLight>& out)
{
    PunctualLight placed;
    placed.directional = light.type == LightType::directional;
    placed.radiant = light.color * light.intensity;
    placed.position = placed.directional ? glm::vec3(0.0f) : glm::vec3(world[3]);
    const glm::dvec3 shines = direction_or(-glm::dvec3(world[2]), glm::dvec3(0.0));
    const bool needs_direction = light.type != LightType::point;
    if (needs_direction)
        placed.direction = glm::vec3(shines);
    if (!finite_f(placed.position) || (needs_direction && glm::dot(shines, shines) == 0.0))
        return;
    if (!placed.directional && light.range > 0.0f)
        placed.inv_range2 = static_cast<float>(1.0 / (static_cast<double>(light.range) * static_cast<double>(light.range)));
    if (light.type == LightType::spot) {
        // KHR_lights_punctual, "Inner and Outer Cone Angles": linear in the cosine; the evaluation squares the value.
        const double outer = det_cos(static_cast<double>(light.outer_cone)), inner = det_cos(static_cast<double>(light.inner_cone));
        const double scale = 1.0 / std::fmax(0.001, inner - outer);
        placed.spot_scale = static_cast<float>(scale);
        placed.spot_offset = static_cast<float>(-outer * scale);
    }
    out.push_back(placed);
}

void set_bounds(DrawTables& out)
{
    bool any = false;
    for (const Draw& draw : out.draws) {
        if (draw.stage)
            continue;
        out.bounds_min = any ? glm::min(out.bounds_min, draw.bounds_min) : draw.bounds_min;
        out.bounds_max = any ? glm::max(out.bounds_max, draw.bounds_max) : draw.bounds_max;
        any = true;
    }
    if (!any)
        out.bounds_min = glm::vec3(-0.5f), out.bounds_max = glm::vec3(0.5f);
}

} // namespace

Status check_draw_size(const Scene& scene, const Limits& limits, const std::string& file)
{
    // Bytes of indices and triangle materials; of positions and shading vertices.
    constexpr std::uint64_t kIndexBytes = sizeof(std::uint32_t) + sizeof(std::uint32_t) / 3 + 1;
    constexpr std::uint64_t kVertexBytes = 3 * sizeof(float) + sizeof(ShadingVertex);
    std::uint64_t vertices = 0, indices = 0;
    for (const Node& node : scene.nodes) {
        if (node.mesh == kNone)
            continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        for (std::uint32_t k = 0; k < mesh.primitive_count; ++k) {
            const Primitive& primitive = scene.primitives[mesh.first_primitive + k];
            vertices += primitive.vertex_count, indices += primitive.index_count; // far below 2^64: both counts are in memory
        }
    }
    const std::uint64_t bytes = vertices * kVertexBytes + indices * kIndexBytes;
    if (bytes > limits.draw_bytes || vertices > kMaxIds || indices > kMaxIds)
        return Error{ExitCode::bad_input, file, "/nodes",
                     "with every instance expanded the scene has " + std::to_string(indices / 3) + " triangles, " + std::to_string(bytes) +
                         " bytes; the limit is " + std::to_string(limits.draw_bytes)};
    return {};
}

DrawTables make_draw_tables(const Scene& scene, const glm::dmat4* motion)
{
    DrawTables out;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        check_stop();
        const Node& node = scene.nodes[i];
        const glm::mat4 world = motion ? glm::mat4(*motion * glm::dmat4(node.world)) : node.world;
        // Place the node's lights
        if (node.light != kNone) {
            BN_CHECK_OP(static_cast<std::size_t>(node.light), <, scene.lights.size());
            append_light(scene.lights[static_cast<std::size_t>(node.light)], world, out.lights);
        }
        if (node.area_light != kNone) {
            BN_CHECK_OP(static_cast<std::size_t>(node.area_light), <, scene.area_lights.size());
            if (const auto placed = place_area_light(scene.area_lights[static_cast<std::size_t>(node.area_light)], world))
                out.area_lights.push_back(*placed);
        }
        // Append a draw for each primitive of the node's mesh
        if (node.mesh == kNone)
            continue;
        BN_CHECK_OP(static_cast<std::size_t>(node.mesh), <, scene.meshes.size());
        const Placement place = make_placement(world);
        if (!place.usable)
            continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        BN_CHECK_OP(std::uint64_t{mesh.first_primitive} + mesh.primitive_count, <=, scene.primitives.size());
        for (std::uint32_t k = 0; k < mesh.primitive_count; ++k)
            append_draw(scene, mesh.first_primitive + k, static_cast<std::int32_t>(i), place, out);
    }
    set_bounds(out);
    return out;
}

} // namespace burnish
