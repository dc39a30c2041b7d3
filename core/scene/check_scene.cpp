#include "core/scene/check_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "core/scene/area_light.h"
#include "core/scene/check_columns.h"

namespace burnish {
namespace {

constexpr double kAny = static_cast<double>(std::numeric_limits<float>::max()); // bound in .def files: any float

std::string at(const char* table, std::size_t i, const char* field)
{
    return fmt::format("/{}/{}/{}", table, i, field);
}

bool finite(const glm::mat4& m)
{
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r]))
                return false;
    return true;
}

// Returns true where an id names a table entry or is kNone.
bool names(std::int32_t id, std::size_t entries)
{
    return id == kNone || (id >= 0 && static_cast<std::size_t>(id) < entries);
}

std::string beyond(std::int32_t id, const char* what, std::size_t entries)
{
    return fmt::format("{} {} does not exist, the scene has {}", what, id, entries);
}

std::string out_of(double value, double least, double most)
{
    const std::string is = fmt::format("{:g} ", value);
    if (!std::isfinite(value))
        return is + "is no finite number";
    return is + (most >= kAny ? fmt::format("lies below {:g}", least) : fmt::format("lies outside {:g} to {:g}", least, most));
}

// Checks that a factor's numbers lie in their range. `name` is the factor.
Status check_numbers(const float* values, int count, double least, double most, const std::string& table, std::size_t i, const char* name)
{
    for (int c = 0; c < count; ++c)
        if (const float v = values[c]; !(v >= static_cast<float>(least) && v <= static_cast<float>(most)))
            return scene_fault(count == 1 ? fmt::format("/{}/{}/{}", table, i, name) : fmt::format("/{}/{}/{}/{}", table, i, name, c),
                               out_of(static_cast<double>(v), least, most));
    return {};
}
template <int kCount> const float* numbers_of(const glm::vec<kCount, float>& v, int& count)
{
    count = kCount;
    return &v[0];
}
const float* numbers_of(const float& v, int& count)
{
    count = 1;
    return &v;
}

// A line of material.def, light.def or area_light.def.
template <class Of> struct Factor {
    const char* name;
    const float* (*numbers)(const Of& of, int& count);
    double least, most;
};
constexpr Factor<Material> kMaterialFactors[] = {
#define BN_FACTOR(kind, name, fallback, path, least, most)                                                                                 \
    {#name, [](const Material& m, int& count) { return numbers_of(m.name, count); }, least, most},
#include "core/scene/material.def"
};
constexpr Factor<Light> kLightFactors[] = {
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most)                                                                           \
    {#name, [](const Light& l, int& count) { return numbers_of(l.name, count); }, least, most},
#include "core/scene/light.def"
};
constexpr Factor<AreaLight> kAreaFactors[] = {
#define BN_AREA_FACTOR(kind, name, path, least, most)                                                                                      \
    {#name, [](const AreaLight& l, int& count) { return numbers_of(l.name, count); }, least, most},
#include "core/scene/area_light.def"
};

template <class Of, std::size_t kFactors>
Status check_factors(const Factor<Of> (&factors)[kFactors], const Of& of, const char* table, std::size_t i, bool any = false)
{
    for (const Factor<Of>& factor : factors) {
        int count = 0;
        const float* values = factor.numbers(of, count);
        BN_TRY(check_numbers(values, count, factor.least, any ? kAny : factor.most, table, i, factor.name));
    }
    return {};
}

struct TextureField {
    const char* name;
    TextureRef Material::*ref;
};
constexpr TextureField kTextureFields[] = {
#define BN_TEXTURE(name, path) {#name, &Material::name},
#include "core/scene/material.def"
};

Status check_texture_ref(const Scene& scene, const TextureRef& ref, std::size_t i, const char* name)
{
    if (!names(ref.texture, scene.textures.size()))
        return scene_fault(at("materials", i, name) + "/texture", beyond(ref.texture, "texture", scene.textures.size()));
    if (ref.uv_set > 1)
        return scene_fault(at("materials", i, name) + "/uv_set", fmt::format("{} is neither 0 nor 1", ref.uv_set));
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 2; ++r)
            if (!std::isfinite(ref.uv_transform[c][r]))
                return scene_fault(at("materials", i, name) + "/uv_transform", "holds a number that is not finite");
    return {};
}

constexpr int kAlphaModes = 0
#define BN_ALPHA_MODE(name, at) +1
#include "core/scene/material.def"
    ;

Status check_material(const Scene& scene, std::size_t i)
{
    const Material& m = scene.materials[i];
    BN_TRY(check_factors(kMaterialFactors, m, "materials", i, m.emitter)); // an emitter's colour is its radiance
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(m.emissive[c] * m.emissive_strength))
            return scene_fault(at("materials", i, "emissive_strength"), "the emission overflows");
    if (m.emitter < kNoEmitter || m.emitter > kSolidEmitter + static_cast<int>(scene.nodes.size()))
        return scene_fault(at("materials", i, "emitter"), fmt::format("{} is no emitter", m.emitter));
    if (static_cast<int>(m.alpha_mode) >= kAlphaModes)
        return scene_fault(at("materials", i, "alpha_mode"), fmt::format("{} is no alpha mode", static_cast<int>(m.alpha_mode)));
    for (const TextureField& field : kTextureFields)
        BN_TRY(check_texture_ref(scene, m.*field.ref, i, field.name));
    return {};
}

Status check_texture(const Scene& scene, std::size_t i)
{
    const Texture& t = scene.textures[i];
    if (t.image == kNone)
        return scene_fault(at("textures", i, "image"), "the texture has no image");
    if (!names(t.image, scene.images.size()))
        return scene_fault(at("textures", i, "image"), beyond(t.image, "image", scene.images.size()));
    for (const auto& [wrap, name] : {std::pair(t.wrap_s, "wrap_s"), std::pair(t.wrap_t, "wrap_t")})
        if (wrap > WrapMode::mirror)
            return scene_fault(at("textures", i, name), fmt::format("{} is no wrap mode", static_cast<int>(wrap)));
    return {};
}

Status check_image(const Image& image, std::size_t i, const Limits& limits)
{
    for (const auto& [side, name] : {std::pair(image.width, "width"), std::pair(image.height, "height")})
        if (side < 1 || side > limits.image_side)
            return scene_fault(at("images", i, name), fmt::format("{} pixels lie outside 1 to {}", side, limits.image_side));
    if (image.channels < 1 || image.channels > 4)
        return scene_fault(at("images", i, "channels"), fmt::format("{} channels, a texture's image has 1 to 4", image.channels));
    if (image.type > PixelType::f32)
        return scene_fault(at("images", i, "type"), fmt::format("{} is no type of pixels", static_cast<int>(image.type)));
    const std::uint64_t row = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height); // below 2^62
    const std::uint64_t texel = static_cast<std::uint64_t>(image.channels) * pixel_type_bytes(image.type);
    if (image.bytes.size() % texel != 0 || image.bytes.size() / texel != row)
        return scene_fault(at("images", i, "bytes"),
                           fmt::format("{} bytes, {} x {} pixels of {} channels have {}", image.bytes.size(), image.width, image.height,
                                       image.channels, static_cast<double>(row) * static_cast<double>(texel)));
    return {};
}

Status check_images(const Scene& scene, const Limits& limits)
{
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        BN_TRY(check_image(scene.images[i], i, limits));
        bytes += scene.images[i].bytes.size();
        if (bytes > limits.texture_bytes)
            return scene_fault(fmt::format("/images/{}", i),
                               fmt::format("the scene's textures need more than {} bytes (Limits::texture_bytes)", limits.texture_bytes));
    }
    return {};
}

Status check_node(const Scene& scene, std::size_t i)
{
    const Node& n = scene.nodes[i];
    if (n.parent != kNone && (n.parent < 0 || static_cast<std::size_t>(n.parent) >= i))
        return scene_fault(at("nodes", i, "parent"), fmt::format("node {} does not come before its child {}", n.parent, i));
    struct Id {
        std::int32_t id;
        const char* what;
        std::size_t entries;
    };
    for (const Id& id : {Id{n.mesh, "mesh", scene.meshes.size()}, Id{n.camera, "camera", scene.cameras.size()},
                         Id{n.light, "light", scene.lights.size()}, Id{n.area_light, "area_light", scene.area_lights.size()}})
        if (!names(id.id, id.entries))
            return scene_fault(at("nodes", i, id.what), beyond(id.id, id.what, id.entries));
    if (!finite(n.local))
        return scene_fault(at("nodes", i, "local"), "holds a number that is not finite");
    if (!finite(n.world))
        return scene_fault(at("nodes", i, "world"), "the transform to world space is not finite");
    for (int c = 0; c < 4; ++c)
        if (!(std::fabs(n.local[c][3] - (c == 3 ? 1.0f : 0.0f)) <= 1e-6f))
            return scene_fault(at("nodes", i, "local"), "is a projection: the last row must be 0 0 0 1");
    return {};
}

Status check_mesh(const Scene& scene, std::size_t i)
{
    const Mesh& m = scene.meshes[i];
    if (std::uint64_t{m.first_primitive} + m.primitive_count <= scene.primitives.size())
        return {};
    const bool first = m.first_primitive > scene.primitives.size();
    return scene_fault(at("meshes", i, first ? "first_primitive" : "primitive_count"),
                       fmt::format("primitives {} to {} do not exist, the scene has {}", m.first_primitive,
                                   std::uint64_t{m.first_primitive} + m.primitive_count, scene.primitives.size()));
}

Status check_light(const Light& light, std::size_t i)
{
    if (light.type > LightType::spot)
        return scene_fault(at("lights", i, "type"), fmt::format("{} is no type of light", static_cast<int>(light.type)));
    Light ranged = light;
    if (light.range == 0.0f) // unlimited
        ranged.range = 1.0f;
    BN_TRY(check_factors(kLightFactors, ranged, "lights", i));
    if (light.type == LightType::spot && light.inner_cone > light.outer_cone)
        return scene_fault(at("lights", i, "inner_cone"), "is wider than outer_cone");
    return {};
}

Status check_area_light(const Scene& scene, std::size_t i)
{
    const AreaLight& light = scene.area_lights[i];
    if (static_cast<int>(light.shape) >= kAreaShapes)
        return scene_fault(at("area_lights", i, "shape"), fmt::format("{} is no shape", static_cast<int>(light.shape)));
    BN_TRY(check_factors(kAreaFactors, light, "area_lights", i));
    if (!names(light.texture, scene.textures.size()))
        return scene_fault(at("area_lights", i, "texture"), beyond(light.texture, "texture", scene.textures.size()));
    if (light.texture == kNone && !light.texture_file.empty())
        return scene_fault(at("area_lights", i, "texture_file"), "is not read yet (read_area_texture())");
    if (const std::string wrong = area_light_fault(light); !wrong.empty())
        return scene_fault(fmt::format("/area_lights/{}", i), wrong);
    return {};
}

Status check_camera(const Camera& c, std::size_t i)
{
    struct Number {
        const char* name;
        float value;
        double least, most;
    };
    const Number perspective[] = {{"yfov", c.yfov, 1e-6, 3.1415927}, {"znear", c.znear, 1e-30, kAny}, {"zfar", c.zfar, 0, kAny}};
    const Number orthographic[] = {
        {"xmag", c.xmag, -kAny, kAny}, {"ymag", c.ymag, -kAny, kAny}, {"znear", c.znear, 0, kAny}, {"zfar", c.zfar, 0, kAny}};
    const Number* const numbers = c.orthographic ? orthographic : perspective;
    for (const Number* n = numbers; n != numbers + (c.orthographic ? std::size(orthographic) : std::size(perspective)); ++n)
        BN_TRY(check_numbers(&n->value, 1, n->least, n->most, "cameras", i, n->name));
    if (c.orthographic && (c.xmag == 0.0f || c.ymag == 0.0f))
        return scene_fault(at("cameras", i, c.xmag == 0.0f ? "xmag" : "ymag"), "is 0");
    if ((c.orthographic || c.zfar != 0.0f) && !(c.zfar > c.znear))
        return scene_fault(at("cameras", i, "zfar"), "is not greater than znear");
    return {};
}

Status check_tables(const Scene& s, const Limits& limits)
{
    const auto each = [](std::size_t count, const auto& check) -> Status {
        for (std::size_t i = 0; i < count; ++i)
            BN_TRY(check(i));
        return {};
    };
    BN_TRY(check_images(s, limits));
    BN_TRY(each(s.textures.size(), [&](std::size_t i) { return check_texture(s, i); }));
    BN_TRY(each(s.materials.size(), [&](std::size_t i) { return check_material(s, i); }));
    BN_TRY(each(s.primitives.size(), [&](std::size_t i) { return check_primitive(s, i); }));
    BN_TRY(each(s.meshes.size(), [&](std::size_t i) { return check_mesh(s, i); }));
    BN_TRY(each(s.lights.size(), [&](std::size_t i) { return check_light(s.lights[i], i); }));
    BN_TRY(each(s.area_lights.size(), [&](std::size_t i) { return check_area_light(s, i); }));
    BN_TRY(each(s.cameras.size(), [&](std::size_t i) { return check_camera(s.cameras[i], i); }));
    return each(s.nodes.size(), [&](std::size_t i) { return check_node(s, i); });
}

} // namespace

Status check_scene_tables(const Scene& scene, const Limits& limits, const std::string& file)
{
    return fault_of_file(check_tables(scene, limits), file);
}

Status check_scene(const Scene& scene, const Limits& limits, const std::string& file)
{
    if (Status ok = check_columns(scene); !ok) // check sizes first: table entries are ranges in columns
        return fault_of_file(ok, file);
    if (Status ok = check_tables(scene, limits); !ok)
        return fault_of_file(ok, file);
    return fault_of_file(check_indices(scene), file);
}

} // namespace burnish
