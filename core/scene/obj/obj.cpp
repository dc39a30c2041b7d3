#include "core/scene/obj/obj.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/colour.h"
#include "core/scene/obj/materials.h"
#include "core/scene/obj/parse.h"
#include "core/scene/tangents.h"

namespace burnish {
namespace {

constexpr std::size_t kMostCorners = 1000; // in a polygon, because ears are clipped one by one
constexpr std::uint64_t kCornerBytes = 128;
constexpr std::size_t kMostMissing = 5, kShownName = 40; // materials named in warnings, and bytes of a name

glm::dvec3 position_of(const obj::Parsed& from, const obj::Corner& c)
{
    const float* p = from.positions.data() + 3 * c.position;
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const glm::dvec3& a, const glm::dvec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Triangulates a polygon by ear clipping and returns corner indices. Clips the first ear without other corners inside,
// or the first corner where there is none, as in self-intersecting polygons.
std::vector<std::size_t> triangles_of(const std::vector<glm::dvec3>& corners)
{
    std::vector<std::size_t> left(corners.size()), out;
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = i;
    // Compute the polygon's normal, and define an ear
    glm::dvec3 normal(0.0);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i)
        normal += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
        return dot(normal, cross(corners[b] - corners[a], corners[c] - corners[a]));
    };
    const auto is_ear = [&](std::size_t at) {
        const std::size_t n = left.size(), a = left[(at + n - 1) % n], b = left[at], c = left[(at + 1) % n];
        if (!(turn(a, b, c) > 0.0))
            return false;
        return std::none_of(left.begin(), left.end(), [&](std::size_t p) {
            return p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        });
    };
    // Clip ears until a triangle is left
    while (left.size() > 3) {
        const std::size_t n = left.size();
        std::size_t at = 1 % n; // gives a fan about the first corner for convex polygons
        for (std::size_t tried = 0; tried < n; ++tried)
            if (is_ear((1 + tried) % n)) {
                at = (1 + tried) % n;
                break;
            }
        out.insert(out.end(), {left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    }
    out.insert(out.end(), left.begin(), left.end());
    return out;
}

// Area-weighted sums of normals at each position, separate for each smoothing group where a file names groups.
struct SmoothNormals {
    std::vector<glm::dvec3> sums;                                           // by position, for corners without a group
    std::map<std::pair<std::int64_t, std::uint32_t>, glm::dvec3> of_groups; // by position and group

    glm::dvec3& at(const obj::Corner& c)
    {
        return c.smoothing == obj::kUnsaid ? sums[static_cast<std::size_t>(c.position)] : of_groups[{c.position, c.smoothing}];
    }
};

SmoothNormals smooth_normals(const obj::Parsed& from, const std::vector<std::vector<obj::Corner>>& groups)
{
    SmoothNormals normals;
    normals.sums.assign(from.positions.size() / 3, glm::dvec3(0.0));
    for (const std::vector<obj::Corner>& corners : groups)
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec3 a = position_of(from, corners[i]);
            const glm::dvec3 area = cross(position_of(from, corners[i + 1]) - a, position_of(from, corners[i + 2]) - a);
            for (std::size_t k = 0; k < 3; ++k)
                normals.at(corners[i + k]) += area;
        }
    return normals;
}

glm::vec3 unit(const glm::dvec3& v)
{
    const double length = std::sqrt(dot(v, v));
    return length > 1e-30 ? glm::vec3(v / length) : glm::vec3(0.0f, 0.0f, 1.0f); // for a triangle without area, which is never visible
}

// Appends the corners. Merges equal corners, in the order of first use.
void append(Scene& scene, const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
            const std::vector<glm::vec4>& tangents, const std::vector<glm::vec2>& uvs, const std::vector<glm::vec3>& colours, bool has_uvs,
            std::int32_t material)
{
    Primitive primitive;
    primitive.material = material;
    primitive.has_uv0 = has_uvs, primitive.has_color = !colours.empty();
    primitive.first_index = static_cast<std::uint32_t>(scene.indices.size());
    primitive.first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    VertexTable& v = scene.vertices;
    const std::array<Column<float>*, 18> columns = {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz,
                                                    &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca};
    std::map<std::array<std::uint32_t, 15>, std::uint32_t> known;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::vec3 &p = positions[i], &n = normals[i];
        const glm::vec4& t = tangents[i];
        const glm::vec3 c = colours.empty() ? glm::vec3(1.0f) : colours[i];
        const float values[18] = {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, t.z, t.w, uvs[i].x, uvs[i].y, 0, 0, c.x, c.y, c.z, 1};
        std::array<std::uint32_t, 15> bits; // all values that vary
        std::memcpy(bits.data(), values, 12 * sizeof(float));
        std::memcpy(bits.data() + 12, values + 14, 3 * sizeof(float));
        const auto [it, is_new] = known.try_emplace(bits, static_cast<std::uint32_t>(v.size()));
        for (std::size_t k = 0; is_new && k < columns.size(); ++k)
            columns[k]->push_back(values[k]);
        scene.indices.push_back(it->second);
    }
    primitive.index_count = static_cast<std::uint32_t>(positions.size());
    primitive.vertex_count = static_cast<std::uint32_t>(v.size()) - primitive.first_vertex;
    scene.primitives.push_back(primitive);
}

// Decodes vertex colours from sRGB, the encoding that Blender, ZBrush and MeshLab write.
glm::vec3 linear_colour(const obj::Parsed& from, const obj::Corner& c)
{
    const float* rgb = from.colours.data() + 3 * c.position;
    return {srgb_to_linear(rgb[0]), srgb_to_linear(rgb[1]), srgb_to_linear(rgb[2])};
}

void add_group(Scene& scene, const obj::Parsed& from, const std::vector<obj::Corner>& corners, SmoothNormals& smooth, std::int32_t material)
{
    std::vector<glm::vec3> positions, normals, colours;
    std::vector<glm::vec2> uvs, upwards; // uvs: v down as in glTF; upwards: v up as in the file, for MikkTSpace
    const bool has_uvs = std::all_of(corners.begin(), corners.end(), [](const obj::Corner& c) { return c.uv >= 0; });
    for (const obj::Corner& c : corners) {
        positions.push_back(glm::vec3(position_of(from, c)));
        const float* n = c.normal >= 0 ? from.normals.data() + 3 * c.normal : nullptr;
        const glm::dvec3 own =
            n ? glm::dvec3(static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])) : glm::dvec3(0.0);
        normals.push_back(unit(dot(own, own) > 1e-30 ? own : smooth.at(c)));
        if (!from.colours.empty())
            colours.push_back(linear_colour(from, c));
        upwards.push_back(has_uvs
                              ? glm::vec2(from.uvs[static_cast<std::size_t>(2 * c.uv)], from.uvs[static_cast<std::size_t>(2 * c.uv + 1)])
                              : glm::vec2(0.0f));
        uvs.push_back(has_uvs ? glm::vec2(upwards.back().x, 1.0f - upwards.back().y) : glm::vec2(0.0f));
    }
    std::vector<glm::vec4> tangents;
    if (has_uvs)
        tangents = mikk_tangents(positions, normals, upwards);
    else
        for (const glm::vec3& n : normals)
            tangents.push_back(glm::vec4(any_tangent(n), 1.0f));
    append(scene, positions, normals, tangents, uvs, colours, has_uvs, material);
}

// Sets the polygon's normal at corners of a faceted polygon that have no normal.
void facet(obj::Parsed& parsed, obj::Corner* corners, const std::vector<glm::dvec3>& points)
{
    if (corners[0].smoothing != obj::kFaceted)
        return;
    glm::dvec3 area(0.0);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        area += cross(points[i] - points[0], points[i + 1] - points[0]);
    const glm::vec3 normal = unit(area);
    const std::int64_t at = static_cast<std::int64_t>(parsed.normals.size() / 3);
    bool used = false;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (corners[i].normal < 0)
            corners[i].normal = at, used = true;
    if (used)
        parsed.normals.insert(parsed.normals.end(), {normal.x, normal.y, normal.z});
}

// Triangulates polygons into corners, by group.
Result<std::vector<std::vector<obj::Corner>>> cut_polygons(obj::Parsed& parsed, const std::string& path, const Limits& limits)
{
    std::uint64_t corners = 0;
    std::vector<std::vector<obj::Corner>> triangles;
    for (obj::Group& group : parsed.groups) {
        std::vector<obj::Corner>& to = triangles.emplace_back();
        std::size_t first = 0;
        for (const std::uint32_t count : group.counts) {
            if (count > kMostCorners)
                return Error{ExitCode::bad_input, path, "", fmt::format("a polygon has {} corners, more than {}", count, kMostCorners)};
            corners += 3 * (count - 2);
            if (corners * kCornerBytes > limits.accessor_bytes)
                return Error{ExitCode::bad_input, path, "",
                             fmt::format("its faces need more than {} bytes (Limits::accessor_bytes)", limits.accessor_bytes)};
            std::vector<glm::dvec3> points;
            for (std::size_t i = first; i < first + count; ++i)
                points.push_back(position_of(parsed, group.corners[i]));
            facet(parsed, group.corners.data() + first, points);
            for (const std::size_t at : triangles_of(points))
                to.push_back(group.corners[first + at]);
            first += count;
        }
    }
    return triangles;
}

// Warns of groups where some corners lack texture coordinates: coordinates count only for a whole group.
void warn_of_missing_uvs(Scene& scene, const obj::Parsed& parsed)
{
    for (const obj::Group& group : parsed.groups) {
        const std::size_t bare = static_cast<std::size_t>(
            std::count_if(group.corners.begin(), group.corners.end(), [](const obj::Corner& c) { return c.uv < 0; }));
        if (bare == 0 || bare == group.corners.size())
            continue;
        scene.warnings.push_back(fmt::format("{} of {} corners of its group '{}' have no texture coordinates, so the group has none", bare,
                                             group.corners.size(), printable(group.name, 40)));
        return;
    }
}

// Returns each group's material. Reads the libraries that the file names.
Result<std::vector<std::int32_t>> materials_of_groups(Scene& scene, const obj::Parsed& parsed, const std::string& path,
                                                      const Limits& limits, bool in_folder, const Jobs* jobs)
{
    std::vector<std::int32_t> worn(parsed.groups.size(), 0);
    const bool wears =
        std::any_of(parsed.groups.begin(), parsed.groups.end(), [](const obj::Group& group) { return !group.material.empty(); });
    if (!wears)
        return worn;
    if (!in_folder || parsed.libraries.empty()) {
        scene.warnings.push_back(in_folder ? "its materials (MTL) lie in no library (mtllib): they are white"
                                           : "its materials (MTL) are read from files alone: they are white");
        return worn;
    }
    const Result<std::map<std::string, std::int32_t>> indices = obj::read_materials(scene, path, parsed.libraries, limits, jobs);
    BN_TRY(indices);
    std::set<std::string> missing;
    for (std::size_t g = 0; g < worn.size(); ++g) {
        const std::string& name = parsed.groups[g].material;
        if (const auto at = indices->find(name); at != indices->end())
            worn[g] = at->second;
        else if (!name.empty() && missing.insert(name).second && missing.size() <= kMostMissing)
            scene.warnings.push_back(fmt::format("no library has material '{}', which is white", printable(name, kShownName)));
    }
    return worn;
}

// in_folder: the path is a file's, whose folder holds its materials.
Result<Scene> load_text(const std::string& text, const std::string& path, const Limits& limits, bool in_folder, const Jobs* jobs)
{
    if (text.find('\0') != std::string::npos)
        return Error{ExitCode::bad_input, path, "", "holds bytes of 0: no text in UTF-8, perhaps UTF-16"};
    // Parse the text, and triangulate its polygons
    obj::Parsed parsed = obj::parse(path, text);
    if (parsed.wrong)
        return *parsed.wrong;
    if (parsed.groups.empty())
        return Error{ExitCode::bad_input, path, "", "holds no faces"};
    const Result<std::vector<std::vector<obj::Corner>>> triangles = cut_polygons(parsed, path, limits);
    BN_TRY(triangles);
    // Make the default material
    Scene scene;
    scene.files.push_back(path);
    Material white;
    white.name = "white";
    white.metallic = 0.0f, white.roughness = 0.4f;
    scene.materials.push_back(white);
    scene.warnings = parsed.warnings;
    const Result<std::vector<std::int32_t>> wears = materials_of_groups(scene, parsed, path, limits, in_folder, jobs);
    BN_TRY(wears);
    const std::vector<std::int32_t>& worn = *wears;
    // Make a mesh and a node for each group
    SmoothNormals smooth = smooth_normals(parsed, *triangles);
    for (std::size_t g = 0; g < triangles->size(); ++g) {
        Mesh mesh;
        mesh.name = parsed.groups[g].name;
        mesh.first_primitive = static_cast<std::uint32_t>(scene.primitives.size());
        mesh.primitive_count = 1;
        add_group(scene, parsed, (*triangles)[g], smooth, worn[g]);
        Node node;
        node.name = mesh.name, node.mesh = static_cast<std::int32_t>(g);
        scene.meshes.push_back(std::move(mesh));
        scene.nodes.push_back(std::move(node));
    }
    warn_of_missing_uvs(scene, parsed);
    update_world(scene);
    return scene;
}

} // namespace

bool is_obj(const std::string& path)
{
    constexpr std::string_view kEnding = ".obj";
    return path.size() >= kEnding.size() && std::equal(kEnding.begin(), kEnding.end(), path.end() - kEnding.size(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

Result<Scene> load_obj(const std::string& path, const Limits& limits, const Jobs* jobs)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, limits.file_bytes);
    BN_TRY(bytes);
    return load_text(std::string(bytes->begin(), bytes->end()), path, limits, true, jobs);
}

Result<Scene> load_obj_text(const std::string& text, const std::string& path, const Limits& limits)
{
    return load_text(text, path, limits, false, nullptr);
}

} // namespace burnish
