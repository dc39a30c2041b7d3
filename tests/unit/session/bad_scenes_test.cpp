// Scenes, environments and frames with one wrong field. Each gives an Error that names the field; none ends the process or draws.
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <span>

#include "core/image/io/image_io.h"
#include "core/scene/check_scene.h"
#include "raster/session/session.h"
#include "tests/unit/small_scene.h"

namespace burnish {
namespace {

using test::good_scene;
using test::small_environment;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

SessionParts good_parts()
{
    static const std::shared_ptr<const SceneData> data = *make_scene_data("good", good_scene(), {});
    return {data, small_environment(), std::make_shared<const Jobs>(1), *standard_dfg(Jobs(1))};
}

FrameDesc good_desc()
{
    FrameDesc d;
    d.width = 40, d.height = 30, d.msaa = 1;
    d.view = make_view(glm::vec3(0.5f, 0.4f, 3), glm::vec3(0), 0.8f, d.width, d.height);
    return d;
}

struct BadScene {
    const char* place; // named by the error
    void (*change)(Scene& s);
};

const BadScene kColumnsAndRanges[] = {
    {"/vertices/nx", [](Scene& s) { s.vertices.nx = {}; }},
    {"/vertices/ny", [](Scene& s) { s.vertices.ny.resize(3); }},
    {"/vertices/nx", [](Scene& s) { s.vertices.nx = {}, s.vertices.ny = {}, s.vertices.nz = {}; }},
    {"/vertices/py", [](Scene& s) { s.vertices.py = {}; }},
    {"/vertices/py", [](Scene& s) { s.vertices.px.resize(5); }},
    {"/vertices/tw", [](Scene& s) { s.vertices.tw.resize(9); }},
    {"/vertices/u0", [](Scene& s) { s.vertices.u0.resize(2); }},
    {"/vertices/v1", [](Scene& s) { s.vertices.v1.resize(1); }},
    {"/vertices/ca", [](Scene& s) { s.vertices.ca.resize(3); }},
    {"/vertices/px/2", [](Scene& s) { s.vertices.px[2] = kNan; }},
    {"/vertices/pz/3", [](Scene& s) { s.vertices.pz[3] = -kInf; }},
    {"/vertices/ny/1", [](Scene& s) { s.vertices.ny[1] = kNan; }},
    {"/vertices/nx/0", [](Scene& s) { s.vertices.nz[0] = -0.0f; }},
    {"/vertices/tx/1", [](Scene& s) { s.vertices.tx[1] = kInf; }},
    {"/vertices/tw/2", [](Scene& s) { s.vertices.tw[2] = 0.0f; }},
    {"/vertices/u0/3", [](Scene& s) { s.vertices.u0[3] = kNan; }},
    {"/vertices/v1/0", [](Scene& s) { s.vertices.v1[0] = kInf; }},
    {"/vertices/cg/0", [](Scene& s) { s.vertices.cg[0] = kNan; }},
    {"/vertices/ca/2", [](Scene& s) { s.vertices.ca[2] = kInf; }},
    {"/primitives/0/indices/1", [](Scene& s) { s.indices[1] = 4; }},
    {"/primitives/0/indices/5", [](Scene& s) { s.indices[5] = 0xffffffffu; }},
    {"/primitives/0/indices/0", [](Scene& s) { s.primitives[0].first_vertex = 1, s.primitives[0].vertex_count = 3; }},
    {"/primitives/0/indices/5", [](Scene& s) { s.primitives[0].vertex_count = 3; }},
    {"/primitives/0/index_count", [](Scene& s) { s.primitives[0].index_count = 9; }},
    {"/primitives/0/index_count", [](Scene& s) { s.primitives[0].index_count = 5; }},
    {"/primitives/0/first_index", [](Scene& s) { s.primitives[0].first_index = 0xfffffffdu; }},
    {"/primitives/0/first_vertex", [](Scene& s) { s.primitives[0].first_vertex = 0xfffffffeu; }},
    {"/primitives/0/vertex_count", [](Scene& s) { s.primitives[0].vertex_count = 5; }},
    {"/primitives/0/material", [](Scene& s) { s.primitives[0].material = 3; }},
    {"/primitives/0/material", [](Scene& s) { s.primitives[0].material = kNone; }},
    {"/primitives/0/material", [](Scene& s) { s.materials.clear(); }},
    {"/meshes/0/primitive_count", [](Scene& s) { s.meshes[0].primitive_count = 2; }},
    {"/meshes/0/primitive_count", [](Scene& s) { s.meshes[0].primitive_count = 0xffffffffu; }},
    {"/meshes/0/first_primitive", [](Scene& s) { s.meshes[0].first_primitive = 7; }},
    // Empty, or without an area
    {"/nodes/0/mesh", [](Scene& s) { s.meshes[0].primitive_count = 0; }},
    {"/nodes/0/mesh", [](Scene& s) { s.primitives[0].index_count = 0; }},
    {"/nodes/0/mesh",
     [](Scene& s) {
         for (std::size_t i = 0; i < s.vertices.size(); ++i)
             s.vertices.px[i] = s.vertices.py[i] = s.vertices.pz[i];
     }},
    {"/nodes/0/mesh",
     [](Scene& s) {
         for (Column<float>* c : {&s.vertices.px, &s.vertices.py, &s.vertices.pz})
             for (float& v : *c)
                 v *= 1e-30f;
     }},
    {"/nodes", [](Scene& s) { s.nodes.clear(); }},
    {"/nodes", [](Scene& s) { s.nodes.resize(1), s.nodes[0].local = glm::mat4(glm::mat3(0.0f)); }},
    {"/nodes", [](Scene& s) { s.nodes.resize(1), s.nodes[0].mesh = kNone; }},
};

const BadScene kNodes[] = {
    {"/nodes/0/mesh", [](Scene& s) { s.nodes[0].mesh = -2; }},
    {"/nodes/0/mesh", [](Scene& s) { s.nodes[0].mesh = 1; }},
    {"/nodes/0/parent", [](Scene& s) { s.nodes[0].parent = 9; }},
    {"/nodes/0/parent", [](Scene& s) { s.nodes[0].parent = 0; }}, // its own parent
    {"/nodes/0/parent", [](Scene& s) { s.nodes[0].parent = 1; }}, // a cycle
    {"/nodes/1/parent", [](Scene& s) { s.nodes[1].parent = -2; }},
    {"/nodes/0/light", [](Scene& s) { s.nodes[0].light = 1; }},
    {"/nodes/1/light", [](Scene& s) { s.nodes[1].light = -5; }},
    {"/nodes/2/camera", [](Scene& s) { s.nodes[2].camera = 1; }},
    {"/nodes/3/area_light", [](Scene& s) { s.nodes[3].area_light = 3; }},
    {"/nodes/0/local", [](Scene& s) { s.nodes[0].local[3][0] = kNan; }},
    {"/nodes/2/local", [](Scene& s) { s.nodes[2].local[1][1] = kInf; }},
    {"/nodes/1/world", [](Scene& s) { s.nodes[0].local[0] *= 1e30f, s.nodes[1].local[0] *= 1e30f; }},
    {"/nodes/0/local", [](Scene& s) { s.nodes[0].local[0][3] = 0.5f; }},
    {"/nodes/1/local", [](Scene& s) { s.nodes[1].local[3][3] = 2.0f; }},
    {"/nodes/0", [](Scene& s) { s.nodes[0].local[3][0] = 1e25f; }},
    {"/nodes/0", [](Scene& s) { s.vertices.px[0] = 3e38f, s.nodes[0].local[0][0] = 3e38f; }},
    {"/cameras/0/yfov", [](Scene& s) { s.cameras[0].yfov = 0.0f; }},
    {"/cameras/0/yfov", [](Scene& s) { s.cameras[0].yfov = kNan; }},
    {"/cameras/0/yfov", [](Scene& s) { s.cameras[0].yfov = 4.0f; }},
    {"/cameras/0/znear", [](Scene& s) { s.cameras[0].znear = -1.0f; }},
    {"/cameras/0/zfar", [](Scene& s) { s.cameras[0].zfar = 0.05f; }},
    {"/cameras/0/zfar", [](Scene& s) { s.cameras[0].orthographic = true; }},
    {"/cameras/0/ymag", [](Scene& s) { s.cameras[0].orthographic = true, s.cameras[0].zfar = 9.0f, s.cameras[0].ymag = 0.0f; }},
    {"/cameras/0/xmag", [](Scene& s) { s.cameras[0].orthographic = true, s.cameras[0].zfar = 9.0f, s.cameras[0].xmag = kInf; }},
    {"/lights/0/type", [](Scene& s) { s.lights[0].type = static_cast<LightType>(7); }},
    {"/lights/0/color/1", [](Scene& s) { s.lights[0].color.y = -1.0f; }},
    {"/lights/0/intensity", [](Scene& s) { s.lights[0].intensity = kNan; }},
    {"/lights/0/intensity", [](Scene& s) { s.lights[0].intensity = kInf; }},
    {"/lights/0/range", [](Scene& s) { s.lights[0].range = -2.0f; }},
    {"/lights/0/outer_cone", [](Scene& s) { s.lights[0].outer_cone = 2.0f; }},
    {"/lights/0/inner_cone", [](Scene& s) { s.lights[0].type = LightType::spot, s.lights[0].inner_cone = 1.0f; }},
    {"/area_lights/0/shape", [](Scene& s) { s.area_lights[0].shape = static_cast<AreaShape>(40); }},
    {"/area_lights/0", [](Scene& s) { s.area_lights[0].points.pop_back(); }},
    {"/area_lights/0", [](Scene& s) { s.area_lights[0].points[2].y = kNan; }},
    {"/area_lights/0", [](Scene& s) { s.area_lights[0].points[2].z = 9.0f; }}, // not in one plane
    {"/area_lights/0/radiance/2", [](Scene& s) { s.area_lights[0].radiance.z = -1.0f; }},
    {"/area_lights/0/radiance/0", [](Scene& s) { s.area_lights[0].radiance.x = kInf; }},
    {"/area_lights/0/radius", [](Scene& s) { s.area_lights[0].radius = kNan; }},
    {"/area_lights/0/texture", [](Scene& s) { s.area_lights[0].texture = 9; }},
    {"/area_lights/0/texture_file", [](Scene& s) { s.area_lights[0].texture_file = "a.png"; }},
};

const BadScene kSurfaces[] = {
    {"/materials/0/emitter", [](Scene& s) { s.materials[0].emitter = 77; }},
    {"/materials/0/emitter", [](Scene& s) { s.materials[0].emitter = -5; }},
    {"/materials/0/base_color/0", [](Scene& s) { s.materials[0].base_color.x = kNan; }},
    {"/materials/0/base_color/3", [](Scene& s) { s.materials[0].base_color.w = 1.5f; }},
    {"/materials/0/metallic", [](Scene& s) { s.materials[0].metallic = -0.5f; }},
    {"/materials/0/roughness", [](Scene& s) { s.materials[0].roughness = 2.0f; }},
    {"/materials/0/roughness", [](Scene& s) { s.materials[0].roughness = kNan; }},
    {"/materials/0/normal_scale", [](Scene& s) { s.materials[0].normal_scale = kInf; }},
    {"/materials/0/emissive/1", [](Scene& s) { s.materials[0].emissive.y = -1.0f; }},
    {"/materials/0/emissive_strength", [](Scene& s) { s.materials[0].emissive_strength = kNan; }},
    {"/materials/0/ior", [](Scene& s) { s.materials[0].ior = -1.5f; }},
    {"/materials/0/specular", [](Scene& s) { s.materials[0].specular = 7.0f; }},
    {"/materials/0/specular_color/2", [](Scene& s) { s.materials[0].specular_color.z = kInf; }},
    {"/materials/0/anisotropy_strength", [](Scene& s) { s.materials[0].anisotropy_strength = -1.0f; }},
    {"/materials/0/anisotropy_rotation", [](Scene& s) { s.materials[0].anisotropy_rotation = kNan; }},
    {"/materials/0/transmission", [](Scene& s) { s.materials[0].transmission = 1.1f; }},
    {"/materials/0/clearcoat", [](Scene& s) { s.materials[0].clearcoat = kNan; }},
    {"/materials/0/clearcoat_roughness", [](Scene& s) { s.materials[0].clearcoat_roughness = -1.0f; }},
    {"/materials/0/conductor_k/0", [](Scene& s) { s.materials[0].conductor_k.x = 1e9f; }},
    {"/materials/0/tilt/1", [](Scene& s) { s.materials[0].tilt.y = 90.0f; }},
    {"/materials/0/height_scale", [](Scene& s) { s.materials[0].height_scale = -1.0f; }},
    {"/materials/0/alpha_cutoff", [](Scene& s) { s.materials[0].alpha_cutoff = kNan; }},
    {"/materials/0/alpha_mode", [](Scene& s) { s.materials[0].alpha_mode = static_cast<AlphaMode>(9); }},
    {"/materials/0/base_color_tex/texture", [](Scene& s) { s.materials[0].base_color_tex.texture = 5; }},
    {"/materials/0/normal_tex/texture", [](Scene& s) { s.materials[0].normal_tex.texture = -2; }},
    {"/materials/0/height_tex/texture", [](Scene& s) { s.materials[0].height_tex.texture = 1; }},
    {"/materials/0/directional_roughness_tex/texture", [](Scene& s) { s.materials[0].directional_roughness_tex.texture = 1; }},
    {"/materials/0/base_color_tex/uv_set", [](Scene& s) { s.materials[0].base_color_tex.uv_set = 2; }},
    {"/materials/0/base_color_tex/uv_transform", [](Scene& s) { s.materials[0].base_color_tex.uv_transform[2][0] = kNan; }},
    {"/textures/0/image", [](Scene& s) { s.textures[0].image = kNone; }},
    {"/textures/0/image", [](Scene& s) { s.textures[0].image = 1; }},
    {"/textures/0/image", [](Scene& s) { s.images.clear(); }},
    {"/textures/0/wrap_t", [](Scene& s) { s.textures[0].wrap_t = static_cast<WrapMode>(3); }},
    {"/images/0/bytes", [](Scene& s) { s.images[0].bytes.clear(); }},
    {"/images/0/bytes", [](Scene& s) { s.images[0].bytes.pop_back(); }},
    {"/images/0/bytes", [](Scene& s) { s.images[0].type = PixelType::f32; }},
    {"/images/0/channels", [](Scene& s) { s.images[0].channels = std::numeric_limits<int>::max(); }},
    {"/images/0/channels", [](Scene& s) { s.images[0] = make_image(4, 4, 5, PixelType::u8); }},
    {"/images/0/channels", [](Scene& s) { s.images[0] = make_image(4, 4, 7, PixelType::f32); }},
    {"/images/0/width", [](Scene& s) { s.images[0].width = -4; }},
    {"/images/0/height", [](Scene& s) { s.images[0].height = 0; }},
    {"/images/0/width", [](Scene& s) { s.images[0].width = s.images[0].height = std::numeric_limits<int>::max(); }},
    {"/images/0/channels", [](Scene& s) { s.images[0].channels = 0; }},
    {"/images/0/type", [](Scene& s) { s.images[0].type = static_cast<PixelType>(8); }},
};

constexpr double kAny = static_cast<double>(std::numeric_limits<float>::max()); // bound in .def files: any float

template <int n> float* floats_of(glm::vec<n, float>& v, int& count)
{
    count = n;
    return &v[0];
}
float* floats_of(float& v, int& count)
{
    count = 1;
    return &v;
}

struct BoundedFactor {
    const char* table; // "/materials/0/"
    const char* name;
    float* (*floats)(Scene& s, int& count);
    double least, most;
};
const BoundedFactor kBounded[] = {
#define BN_FACTOR(kind, name, fallback, path, least, most)                                                                                 \
    {"/materials/0/", #name, [](Scene& s, int& count) { return floats_of(s.materials[0].name, count); }, least, most},
#include "core/scene/material.def"
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most)                                                                           \
    {"/lights/0/", #name, [](Scene& s, int& count) { return floats_of(s.lights[0].name, count); }, least, most},
#include "core/scene/light.def"
#define BN_AREA_FACTOR(kind, name, path, least, most)                                                                                      \
    {"/area_lights/0/", #name, [](Scene& s, int& count) { return floats_of(s.area_lights[0].name, count); }, least, most},
#include "core/scene/area_light.def"
};

// Returns values that the factor must refuse.
std::vector<float> refused_values(const BoundedFactor& factor)
{
    std::vector<float> values = {kNan, kInf, -kInf};
    if (factor.least > -kAny)
        values.push_back(std::nextafter(static_cast<float>(factor.least), -kInf));
    if (factor.most < kAny)
        values.push_back(std::nextafter(static_cast<float>(factor.most), kInf));
    return values;
}

void expect_refused(std::span<const BadScene> cases)
{
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(std::string("case ") + std::to_string(i) + " " + cases[i].place);
        Scene scene = good_scene();
        cases[i].change(scene);
        update_world(scene); // like a caller that builds a scene
        const Result<std::shared_ptr<const SceneData>> data = make_scene_data("mine", std::move(scene), {});
        ASSERT_FALSE(data);
        EXPECT_EQ(data.error().code, ExitCode::bad_input);
        EXPECT_EQ(data.error().file, "mine");
        EXPECT_EQ(data.error().place, cases[i].place) << data.error().line();
    }
}

TEST(bad_scenes, a_good_one_is_drawn)
{
    Result<Session> session = Session::make(good_parts());
    ASSERT_TRUE(session) << session.error().line();
    const Result<Frame> frame = session->render(good_desc());
    ASSERT_TRUE(frame) << frame.error().line();
    EXPECT_EQ(count_not_finite(frame->color), 0u);
    EXPECT_GT(frame->stats.visible_fragments, 100u);
}

TEST(bad_scenes, light_beyond_floats_is_an_error)
{
    Scene lamp = good_scene(), colours = good_scene();
    lamp.lights[0].intensity = 3e38f, lamp.nodes[1].local[3] = glm::vec4(0, 0, 0.1f, 1); // times 1 / distance^2 overflows
    for (Column<float>* c : {&colours.vertices.cr, &colours.vertices.cg, &colours.vertices.cb})
        for (std::size_t k = 0; k < 4; ++k)
            (*c)[k] = 3e38f;
    colours.primitives[0].has_color = true;
    for (Scene* scene : {&lamp, &colours}) {
        SCOPED_TRACE(scene == &lamp ? "a lamp" : "colours of vertices");
        scene->materials[0].base_color_tex.texture = kNone; // white
        update_world(*scene);
        SessionParts parts = good_parts();
        Result<std::shared_ptr<const SceneData>> data = make_scene_data("mine", std::move(*scene), {});
        ASSERT_TRUE(data) << data.error().line();
        parts.scene = *data;
        Result<Session> session = Session::make(parts);
        ASSERT_TRUE(session) << session.error().line();
        FrameDesc desc = good_desc();
        desc.msaa = 4;
        const Result<Frame> frame = session->render(desc), any = session->render_any(desc);
        ASSERT_FALSE(frame) << count_not_finite(frame->color);
        EXPECT_EQ(frame.error().code, ExitCode::not_finite);
        EXPECT_EQ(frame.error().file, "mine");
        ASSERT_TRUE(any);
        EXPECT_GT(count_not_finite(any->color), 0u);
    }
}

TEST(bad_scenes, columns_and_ranges_are_checked)
{
    expect_refused(kColumnsAndRanges);
}

TEST(bad_scenes, nodes_cameras_and_lights_are_checked)
{
    expect_refused(kNodes);
}

TEST(bad_scenes, materials_and_pictures_are_checked)
{
    expect_refused(kSurfaces);
}

TEST(bad_scenes, settings_of_mip_filters_are_checked)
{
    const auto field_of = [](const MipSettings& settings) { return make_scene_data("", good_scene(), {}, settings).error().field; };
    MipSettings settings;
    settings.filter = static_cast<MipFilter>(99);
    EXPECT_EQ(field_of(settings), "MipSettings::filter");
    settings = {}, settings.kappa = -1.0f;
    EXPECT_EQ(field_of(settings), "MipSettings::kappa");
    settings = {}, settings.brdf = 99;
    EXPECT_EQ(field_of(settings), "MipSettings::brdf");
}

// Every number of every factor, with every kind of wrong value. A number that stands for "none" may be 0.
TEST(bad_scenes, every_number_of_every_factor_is_checked)
{
    int refused = 0;
    for (const BoundedFactor& factor : kBounded) {
        int count = 0;
        Scene first = good_scene();
        static_cast<void>(factor.floats(first, count));
        for (int i = 0; i < count; ++i)
            for (const float value : refused_values(factor)) {
                Scene scene = good_scene();
                factor.floats(scene, count)[i] = value;
                if (value == 0.0f)
                    continue;
                SCOPED_TRACE(std::string(factor.table) + factor.name + " " + std::to_string(i) + ": " + std::to_string(value));
                const auto data = make_scene_data("mine", std::move(scene), {});
                ASSERT_FALSE(data);
                EXPECT_EQ(data.error().code, ExitCode::bad_input);
                EXPECT_EQ(data.error().place.rfind(std::string(factor.table) + factor.name, 0), 0u) << data.error().line();
                ++refused;
            }
    }
    EXPECT_GE(refused, 200);
}

// Every place of every column of vertices.
TEST(bad_scenes, every_number_of_every_column_is_checked)
{
    const std::pair<const char*, Column<float> VertexTable::*> columns[] = {
        {"px", &VertexTable::px}, {"py", &VertexTable::py}, {"pz", &VertexTable::pz}, {"nx", &VertexTable::nx}, {"ny", &VertexTable::ny},
        {"nz", &VertexTable::nz}, {"tx", &VertexTable::tx}, {"ty", &VertexTable::ty}, {"tz", &VertexTable::tz}, {"tw", &VertexTable::tw},
        {"u0", &VertexTable::u0}, {"v0", &VertexTable::v0}, {"u1", &VertexTable::u1}, {"v1", &VertexTable::v1}, {"cr", &VertexTable::cr},
        {"cg", &VertexTable::cg}, {"cb", &VertexTable::cb}, {"ca", &VertexTable::ca}};
    for (const auto& [name, column] : columns)
        for (std::size_t vertex = 0; vertex < 4; ++vertex)
            for (const float value : {kNan, kInf, -kInf}) {
                Scene scene = good_scene();
                (scene.vertices.*column)[vertex] = value;
                const auto data = make_scene_data("mine", std::move(scene), {});
                ASSERT_FALSE(data) << name << " " << vertex;
                EXPECT_EQ(data.error().place, std::string("/vertices/") + name + "/" + std::to_string(vertex)) << value;
            }
}

TEST(bad_scenes, limits_hold_in_memory)
{
    Limits limits;
    limits.image_side = 3;
    EXPECT_EQ(make_scene_data("", good_scene(), limits).error().place, "/images/0/width");
    limits = {}, limits.texture_bytes = 47;
    EXPECT_EQ(make_scene_data("", good_scene(), limits).error().place, "/images/0");
}

// Tangents, texture coordinates and colours are optional. Without them the image equals one with their default values.
TEST(bad_scenes, optional_columns_are_filled)
{
    Scene bare = good_scene();
    for (Column<float> VertexTable::*c : {&VertexTable::tx, &VertexTable::ty, &VertexTable::tz, &VertexTable::tw, &VertexTable::u1,
                                          &VertexTable::v1, &VertexTable::cr, &VertexTable::cg, &VertexTable::cb, &VertexTable::ca})
        bare.vertices.*c = {};
    SessionParts parts = good_parts();
    std::uint64_t hash[2];
    for (std::uint64_t& h : hash) {
        Result<Session> session = Session::make(parts);
        ASSERT_TRUE(session);
        h = pixel_hash(session->render(good_desc())->color);
        const Result<std::shared_ptr<const SceneData>> data = make_scene_data("bare", bare, {});
        ASSERT_TRUE(data) << data.error().line();
        parts.scene = *data;
    }
    EXPECT_EQ(hash[0], hash[1]);
}

struct BadParts {
    const char* place;
    void (*change)(SceneData& data, Environment& environment, DfgTable& dfg);
};
const BadParts kParts[] = {
    {"/vertices/nx", [](SceneData& d, Environment&, DfgTable&) { d.scene.vertices.nx = {}; }},
    {"/materials/0/roughness", [](SceneData& d, Environment&, DfgTable&) { d.scene.materials[0].roughness = kNan; }},
    {"/images/0/bytes", [](SceneData& d, Environment&, DfgTable&) { d.scene.images[0].bytes.clear(); }},
    {"/nodes/0/world", [](SceneData& d, Environment&, DfgTable&) { d.scene.nodes[0].world[0][0] = kNan; }},
    {"/tables/py", [](SceneData& d, Environment&, DfgTable&) { d.tables.py = {}; }},
    {"/tables/shading", [](SceneData& d, Environment&, DfgTable&) { d.tables.shading.resize(1); }},
    {"/tables/px/1", [](SceneData& d, Environment&, DfgTable&) { d.tables.px[1] = kNan; }},
    {"/tables/shading/2", [](SceneData& d, Environment&, DfgTable&) { d.tables.shading[2].normal[0] = kInf; }},
    {"/tables/indices", [](SceneData& d, Environment&, DfgTable&) { d.tables.indices.resize(5); }},
    {"/tables/indices/4", [](SceneData& d, Environment&, DfgTable&) { d.tables.indices[4] = 77777; }},
    {"/tables/triangle_material", [](SceneData& d, Environment&, DfgTable&) { d.tables.triangle_material = {}; }},
    {"/tables/triangle_material/0", [](SceneData& d, Environment&, DfgTable&) { d.tables.triangle_material[0] = 99; }},
    {"/tables/draws/0/material", [](SceneData& d, Environment&, DfgTable&) { d.tables.draws[0].material = 99; }},
    {"/tables/draws/0/triangle_count", [](SceneData& d, Environment&, DfgTable&) { d.tables.draws[0].triangle_count = 99; }},
    {"/tables/draws/0/node", [](SceneData& d, Environment&, DfgTable&) { d.tables.draws[0].node = 99; }},
    {"/tables/clusters/0/draw", [](SceneData& d, Environment&, DfgTable&) { d.tables.clusters[0].draw = 99; }},
    {"/tables/clusters/0/triangle_count", [](SceneData& d, Environment&, DfgTable&) { d.tables.clusters[0].triangle_count = 99; }},
    {"/tables/lights/0", [](SceneData& d, Environment&, DfgTable&) { d.tables.lights[0].radiant.x = kNan; }},
    {"/tables/area_lights/0/point_count", [](SceneData& d, Environment&, DfgTable&) { d.tables.area_lights[0].point_count = 99; }},
    {"/tables/area_lights/0/texture", [](SceneData& d, Environment&, DfgTable&) { d.tables.area_lights[0].texture = 99; }},
    {"/mips/materials/0/filter", [](SceneData& d, Environment&, DfgTable&) { d.mips.materials[0].filter = static_cast<MipFilter>(99); }},
    {"/mips/materials/0/kappa", [](SceneData& d, Environment&, DfgTable&) { d.mips.materials[0].kappa = -1.0f; }},
    {"/mips/materials/0/lobe", [](SceneData& d, Environment&, DfgTable&) { d.mips.materials[0].lobe = static_cast<mipnet::Lobe>(99); }},
    {"/specular/texels", [](SceneData&, Environment& e, DfgTable&) { e.specular.texels = {}; }},
    {"/specular/levels", [](SceneData&, Environment& e, DfgTable&) { e.specular.levels = 40; }},
    {"/specular/offset", [](SceneData&, Environment& e, DfgTable&) { e.specular.offset.clear(); }},
    {"/specular/offset/1", [](SceneData&, Environment& e, DfgTable&) { e.specular.offset[1] += 1; }},
    {"/specular/scale", [](SceneData&, Environment& e, DfgTable&) { e.specular.scale = kNan; }},
    {"/irradiance/size", [](SceneData&, Environment& e, DfgTable&) { e.irradiance.size = 31; }},
    {"/rotation_deg", [](SceneData&, Environment& e, DfgTable&) { e.rotation_deg = kNan; }},
    {"/extracted_lights", [](SceneData&, Environment& e, DfgTable&) { e.whole = e.specular, e.extracted_lights.resize(99); }},
    {"/dfg/size", [](SceneData&, Environment&, DfgTable& t) { t.size = -1; }},
    {"/dfg/pairs", [](SceneData&, Environment&, DfgTable& t) { t.pairs.resize(2); }},
};

TEST(bad_scenes, parts_are_checked)
{
    for (const BadParts& bad : kParts) {
        SCOPED_TRACE(bad.place);
        SessionParts parts = good_parts();
        auto data = std::make_shared<SceneData>(*parts.scene);
        auto environment = std::make_shared<Environment>(*parts.environment);
        auto dfg = std::make_shared<DfgTable>(*parts.dfg);
        bad.change(*data, *environment, *dfg);
        parts.scene = data, parts.environment = environment, parts.dfg = dfg;
        const Result<Session> session = Session::make(parts);
        ASSERT_FALSE(session);
        EXPECT_EQ(session.error().code, ExitCode::bad_input);
        EXPECT_EQ(session.error().place, bad.place) << session.error().line();
    }
}

TEST(bad_scenes, environments_from_memory_are_checked)
{
    EnvironmentOptions options;
    options.cube_size = 16, options.samples = 4, options.use_cache = false;
    Image image = make_image(16, 8, 3, PixelType::f32);
    ASSERT_TRUE(bake_environment(image, "mine", options, Jobs(1)));
    image.bytes.clear();
    const Result<Environment> empty = bake_environment(image, "mine", options, Jobs(1));
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().place, "/bytes");
    EXPECT_FALSE(bake_environment(Image{-16, 8, 3, PixelType::f32, {}}, "mine", options, Jobs(1)));
    for (const int size : {0, -4, 3, 1 << 20}) {
        EnvironmentOptions wrong = options;
        wrong.cube_size = size;
        EXPECT_FALSE(bake_environment(make_image(16, 8, 3, PixelType::f32), "mine", wrong, Jobs(1)));
    }
}

TEST(bad_scenes, threads_and_pictures_to_write_are_checked)
{
    OpenOptions open;
    open.threads = -1;
    const Result<Session> session = Session::open("builtin:plate", "builtin:studio", open);
    ASSERT_FALSE(session);
    EXPECT_EQ(session.error().field, "OpenOptions::threads");
    EXPECT_GE(Jobs(-1).threads(), 1);
    const std::string path = testing::TempDir() + "never_written.png";
    for (const Image& image :
         {Image{}, Image{4, 4, 3, PixelType::u8, {}}, Image{-4, 4, 3, PixelType::u8, {}}, make_image(4, 4, 5, PixelType::u8)}) {
        const Status written = write_image(path, image);
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().code, ExitCode::output_failed);
        EXPECT_FALSE(encode_png(image));
    }
    EXPECT_FALSE(write_channels(testing::TempDir() + "never_written.exr", make_image(4, 4, 2, PixelType::f32), {"one"}));
}

} // namespace
} // namespace burnish
