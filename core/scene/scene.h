// Scene: the tables that every renderer shares. Ids are indices into the tables; -1 means none.
// Conventions: right-handed, +Y up, metres, radians; colours linear Rec.709; storage order row-major, top row first;
// matrices column-major as in glTF and GLM; front faces are counter-clockwise.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/base/column.h"
#include "core/image/image.h"

namespace burnish {

inline constexpr int kNone = -1;

// One vertex table for the whole scene; a primitive owns a contiguous range of it. Object space.
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
    std::int32_t parent = kNone, mesh = kNone, camera = kNone, light = kNone;
    glm::mat4 local{1.0f}; // to the parent's space
    glm::mat4 world{1.0f}; // to world space; update_world() fills it
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

struct TextureRef {
    std::int32_t texture = kNone;   // into Scene::textures
    std::uint8_t uv_set = 0;        // 0 or 1
    glm::mat3x2 uv_transform{1.0f}; // uv' = uv_transform * (u, v, 1); KHR_texture_transform
    bool used() const { return texture != kNone; }
};

// glTF 2.0 metallic-roughness with the extensions of the same names. Factors multiply textures.
struct Material {
    std::string name;
    glm::vec4 base_color{1.0f};              // linear, alpha
    float metallic = 1.0f, roughness = 1.0f; // perceptual roughness, alpha = roughness^2
    float normal_scale = 1.0f, occlusion_strength = 1.0f;
    glm::vec3 emissive{0.0f}; // emissiveFactor * KHR_materials_emissive_strength, cd/m^2 up to exposure
    float ior = 1.5f;         // KHR_materials_ior
    float specular = 1.0f;    // KHR_materials_specular
    glm::vec3 specular_color{1.0f};
    float anisotropy_strength = 0.0f; // KHR_materials_anisotropy, [0,1]
    float anisotropy_rotation = 0.0f; // radians, counter-clockwise from the tangent
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;                // KHR_materials_unlit
    TextureRef base_color_tex;         // sRGB, alpha linear
    TextureRef metallic_roughness_tex; // linear; G roughness, B metallic
    TextureRef normal_tex;             // linear, tangent space
    TextureRef occlusion_tex;          // linear, R
    TextureRef emissive_tex;           // sRGB
    TextureRef specular_tex;           // linear, A
    TextureRef specular_color_tex;     // sRGB
    TextureRef anisotropy_tex;         // linear; RG direction, B strength
};

enum class WrapMode : std::uint8_t { repeat, clamp, mirror };

struct Texture { // an image with its sampler
    std::string name;
    std::int32_t image = kNone;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false; // magnification and minification without interpolation
};

enum class LightType : std::uint8_t { directional, point, spot };

struct Light { // KHR_lights_punctual; shines along -Z of its node
    std::string name;
    LightType type = LightType::point;
    glm::vec3 color{1.0f};
    float intensity = 1.0f;                            // candela, or lux for directional
    float range = 0.0f;                                // metres; 0: unlimited
    float inner_cone = 0.0f, outer_cone = 0.78539816f; // radians
};

struct Camera { // looks along -Z of its node, +Y up
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
    std::vector<Camera> cameras;
    std::vector<std::string> files;    // paths of every file that was read for it
    std::vector<std::string> warnings; // one line each, in the order found
};

void update_world(Scene& scene); // fills Node::world from Node::local

} // namespace burnish
