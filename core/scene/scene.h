// Scene: the tables that every renderer shares. Ids are indices into the tables; -1 means none.
// Conventions: right-handed, +Y up, metres, radians; colours linear Rec.709; storage order row-major, top row first;
// matrices column-major as in glTF and GLM; front faces are counter-clockwise.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/column.h"
#include "core/image/image.h"

namespace burnish {

inline constexpr int kNone = -1;

// One vertex table for the whole scene; a primitive owns a contiguous range in this table. Object space.
struct VertexTable {
    Column<float> px, py, pz;     // position, finite
    Column<float> nx, ny, nz;     // unit normal
    Column<float> tx, ty, tz, tw; // unit tangent, orthogonal to the normal; tw = +1 or -1, bitangent = tw * cross(n, t)
    Column<float> u0, v0, u1, v1; // two texture coordinate sets, glTF orientation (v = 0 is the top row)
    Column<float> cr, cg, cb, ca; // vertex colour, linear, 1 where the file has none
    std::size_t size() const { return px.size(); }
};

struct Primitive {
    std::uint32_t first_index = 0, index_count = 0;   // triangles, into Scene::indices; index_count is a multiple of 3
    std::uint32_t first_vertex = 0, vertex_count = 0; // indices are absolute and lie in this range
    std::int32_t material = 0;
    bool has_uv0 = false, has_uv1 = false, has_color = false, has_file_tangents = false;
};

struct Mesh {
    std::string name;
    std::uint32_t first_primitive = 0, primitive_count = 0;
};

// Parents come before their children.
struct Node {
    std::string name;
    std::int32_t parent = kNone, mesh = kNone, camera = kNone, light = kNone, area_light = kNone;
    bool stage = false;           // its mesh is a floor or backdrop, which views do not frame
    glm::mat4 local{1.0f};        // to the parent's space
    glm::dvec3 local_beyond{0.0}; // the translation's rest that floats leave
    glm::mat4 world{1.0f};        // to world space, from the scene's origin; update_world() fills it
};

enum class AlphaMode : std::uint8_t {
#define BN_ALPHA_MODE(name, at) name = at,
#include "core/scene/material.def"
};

struct TextureRef {
    std::int32_t texture = kNone;   // into Scene::textures
    std::uint8_t uv_set = 0;        // 0 or 1
    glm::mat3x2 uv_transform{1.0f}; // uv' = uv_transform * (u, v, 1); KHR_texture_transform
    bool used() const { return texture != kNone; }
};

struct FieldKinds { // in material.def, light.def and area_light.def
    using number = float;
    using vec2 = glm::vec2;
    using vec3 = glm::vec3;
    using vec4 = glm::vec4;
    using flag = bool;
};

// Material::emitter, besides kSolidEmitter + an area light's place in the draw tables.
inline constexpr int kNoEmitter = 0;    // it shows no area light
inline constexpr int kOpenEmitter = 1;  // light rays pass through it; cameras see it
inline constexpr int kSolidEmitter = 2; // it stands in the light's way

struct Material { // material.def
    std::string name;
#define BN_FACTOR(kind, name, fallback, path, least, most) FieldKinds::kind name = FieldKinds::kind(fallback);
#define BN_FLAG(kind, name, path) bool name = false;
#define BN_CHOICE(type, name, words, path) type name = type{};
#define BN_TEXTURE(name, path) TextureRef name;
#include "core/scene/material.def"
    int emitter = kNoEmitter;    // whether it shows an area light, see above
    bool has_height_map = false; // normal_tex's alpha holds heights, [0,1]
};

enum class WrapMode : std::uint8_t { repeat, clamp, mirror };

struct Texture { // an image with its sampler
    std::string name;
    std::int32_t image = kNone;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false; // magnification and minification without interpolation
};

enum class LightType : std::uint8_t { directional, point, spot };

struct Light { // light.def; shines along its node's -Z
    std::string name;
    LightType type = LightType::point;
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most) FieldKinds::kind name = FieldKinds::kind(fallback);
#include "core/scene/light.def"
};

enum class AreaShape : std::uint8_t {
#define BN_AREA_SHAPE(name, at, least, most, what) name = at,
#include "core/scene/area_light.def"
};

struct AreaLight { // area_light.def
    AreaShape shape = AreaShape::quad;
    std::vector<glm::vec3> points; // metres, in its node's space
    bool two_sided = false;
    bool solid = false;           // it stands in other light's way, as a surface does
    std::int32_t texture = kNone; // of quads: what radiance is multiplied by, its lower left corner at the first point and its lower
                                  // right one at the second
    std::string texture_file;     // the same where it is not read yet (read_area_texture())
#define BN_AREA_FACTOR(kind, name, path, least, most) FieldKinds::kind name = FieldKinds::kind(0.0f);
#include "core/scene/area_light.def"
};

struct Camera { // looks along its node's -Z, +Y up
    std::string name;
    bool orthographic = false;
    float yfov = 0.78539816f;        // radians, perspective
    float znear = 0.1f, zfar = 0.0f; // zfar 0: infinite
    float xmag = 1.0f, ymag = 1.0f;  // half extents, orthographic
};

struct Scene {
    std::string name;
    VertexTable vertices;
    Column<std::uint32_t> indices;
    std::vector<Primitive> primitives;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Material> materials; // never empty once loaded: primitives without a material use an added default
    std::vector<Texture> textures;
    std::vector<Image> images; // decoded, as stored in the file
    std::vector<Light> lights;
    std::vector<AreaLight> area_lights;
    std::vector<Camera> cameras;
    glm::dvec3 origin{0.0};            // for places in world space; 0 but for scenes far away (core/scene/origin.h)
    std::vector<std::string> variants; // its file's variant names (KHR_materials_variants), which Moment::variant chooses from
    bool image_light = false;          // its file has an image light for it (image_light.h)
    std::vector<std::string> files;    // paths of every file that was read for it
    std::vector<std::string> warnings; // one line each, in the order found
};

// The state that a scene is read in: a moment in an animation, and a variant for the materials.
struct Moment {
    std::optional<float> seconds; // from 0 on; empty: the scene at rest
    int animation = 0;
    std::string variant = {}; // a name in Scene::variants; empty: the meshes' own materials
};

// Returns "material 'steel'", or "material 3" for the scene's fourth if it has no name. `of` is one of the scene's materials.
std::string material_text(const Scene& scene, const Material& of);

void update_world(Scene& scene); // fills Node::world from Node::local and the origin
// All nodes' transforms to world space, from 0, with all the file's digits.
std::vector<glm::dmat4> exact_world(const Scene& scene);

} // namespace burnish
