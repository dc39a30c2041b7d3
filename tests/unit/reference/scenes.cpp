#include "tests/unit/reference/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/area_light.h"
#include "tests/unit/reference/formulas.h"

namespace burnish::test {

Environment environment_of(const std::function<glm::vec3(const glm::vec3&)>& radiance, int size, const Jobs& jobs)
{
    const int w = 4 * size, h = 2 * size;
    Image image = make_image(w, h, 3, PixelType::f32);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const double phi = ((x + 0.5) / w - 0.5) * 2.0 * 3.14159265358979, theta = (y + 0.5) / h * 3.14159265358979;
            const glm::vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            const glm::vec3 c = radiance(d);
            for (int k = 0; k < 3; ++k)
                image.f32()[(y * w + x) * 3 + k] = c[k];
        }
    EnvironmentOptions options;
    options.cube_size = size;
    options.samples = 16;
    options.use_cache = false;
    Result<Environment> environment = bake_environment(image, "analytic", options, jobs);
    EXPECT_TRUE(environment);
    return *environment;
}

Stage under_coloured_sky(const Scene& scene)
{
    Stage stage(scene, 1.0f, 2);
    static const Environment sky = environment_of([](const glm::vec3& d) { return glm::vec3(coloured_sky(d)); }, 64, stage.jobs);
    static const DfgTable dfg = bake_dfg(64, 4096, stage.jobs);
    stage.environment = sky, stage.dfg = dfg;
    return stage;
}

namespace {

TextureRef add_image(Scene& to, const Image& image)
{
    Texture texture;
    texture.image = static_cast<std::int32_t>(to.images.size());
    to.images.push_back(image);
    TextureRef ref;
    ref.texture = static_cast<std::int32_t>(to.textures.size());
    to.textures.push_back(texture);
    return ref;
}

} // namespace

TextureRef add_texel(Scene& to, const glm::ivec3& code)
{
    Image image = make_image(1, 1, 3, PixelType::u8);
    for (int c = 0; c < 3; ++c)
        image.bytes[static_cast<std::size_t>(c)] = static_cast<std::byte>(code[c]);
    return add_image(to, image);
}

TextureRef add_texel(Scene& to, const glm::vec3& values)
{
    Image image = make_image(1, 1, 3, PixelType::f32);
    for (int c = 0; c < 3; ++c)
        image.f32()[c] = values[c];
    return add_image(to, image);
}

TextureRef add_texel(Scene& to, const glm::vec4& values)
{
    Image image = make_image(1, 1, 4, PixelType::f32);
    for (int c = 0; c < 4; ++c)
        image.f32()[c] = values[c];
    return add_image(to, image);
}

namespace {

void push_vertex(Scene& s, const glm::vec3& p, const glm::vec3& n, const glm::vec3& t)
{
    VertexTable& v = s.vertices;
    v.px.push_back(p.x), v.py.push_back(p.y), v.pz.push_back(p.z);
    v.nx.push_back(n.x), v.ny.push_back(n.y), v.nz.push_back(n.z);
    v.tx.push_back(t.x), v.ty.push_back(t.y), v.tz.push_back(t.z), v.tw.push_back(1.0f);
    for (Column<float>* c : {&v.u0, &v.v0, &v.u1, &v.v1})
        c->push_back(0.0f);
    for (Column<float>* c : {&v.cr, &v.cg, &v.cb, &v.ca})
        c->push_back(1.0f);
}

Scene finished(Scene s, const Material& material)
{
    Primitive p;
    p.index_count = static_cast<std::uint32_t>(s.indices.size());
    p.vertex_count = static_cast<std::uint32_t>(s.vertices.size());
    s.primitives.push_back(p);
    s.meshes.push_back({"mesh", 0, 1});
    Node node;
    node.mesh = 0;
    s.nodes.push_back(node);
    s.materials.push_back(material);
    update_world(s);
    return s;
}

} // namespace

Scene plane_scene(const Material& material)
{
    Scene s;
    for (const glm::vec2 c : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        push_vertex(s, {c.x, c.y, 0}, {0, 0, 1}, {1, 0, 0});
    for (std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
        s.indices.push_back(i);
    return finished(std::move(s), material);
}

Scene ball_scene(const Material& material, bool inside)
{
    constexpr int kColumns = 64, kRows = 32;
    Scene s;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i <= kColumns; ++i) {
            const double theta = 3.14159265358979 * j / kRows, phi = 2.0 * 3.14159265358979 * i / kColumns;
            const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
            push_vertex(s, n, inside ? -n : n, {-std::sin(phi), 0, -std::cos(phi)});
        }
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((j + b) * (kColumns + 1) + i + a); };
            for (const auto& t : {glm::uvec3(at(0, 0), at(0, 1), at(1, 1)), glm::uvec3(at(0, 0), at(1, 1), at(1, 0))}) {
                s.indices.push_back(t.x);
                s.indices.push_back(inside ? t.z : t.y);
                s.indices.push_back(inside ? t.y : t.z);
            }
        }
    return finished(std::move(s), material);
}

Scene room_scene(const Material& material)
{
    Scene s;
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            glm::vec3 n(0.0f), t(0.0f);
            n[axis] = -side, t[(axis + 1) % 3] = 1.0f;
            const glm::vec3 b = glm::cross(n, t);
            const auto first = static_cast<std::uint32_t>(s.vertices.size());
            for (const glm::vec2 c : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
                push_vertex(s, t * c.x + b * c.y - n, n, t);
            for (std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
                s.indices.push_back(first + i);
        }
    return finished(std::move(s), material);
}

void add_scene(Scene& to, const Scene& from, const glm::vec3& offset, float scale)
{
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    const VertexTable& v = from.vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
        push_vertex(to, glm::vec3(v.px[i], v.py[i], v.pz[i]) * scale + offset, {v.nx[i], v.ny[i], v.nz[i]}, {v.tx[i], v.ty[i], v.tz[i]});
    Primitive p;
    p.first_index = static_cast<std::uint32_t>(to.indices.size());
    p.index_count = static_cast<std::uint32_t>(from.indices.size());
    p.first_vertex = first, p.vertex_count = static_cast<std::uint32_t>(v.size());
    p.material = static_cast<std::int32_t>(to.materials.size());
    for (std::size_t i = 0; i < from.indices.size(); ++i)
        to.indices.push_back(from.indices[i] + first);
    to.materials.push_back(from.materials[0]);
    Node node;
    node.mesh = static_cast<std::int32_t>(to.meshes.size());
    to.meshes.push_back({"mesh", static_cast<std::uint32_t>(to.primitives.size()), 1});
    to.primitives.push_back(p);
    to.nodes.push_back(node);
    update_world(to);
}

Scene lit_by(Scene scene, const std::vector<AreaLight>& lights, bool shown)
{
    for (const AreaLight& light : lights)
        add_area_light(scene, light);
    update_world(scene);
    if (shown) {
        EXPECT_TRUE(add_emitters(scene, 256, ""));
        update_world(scene);
    }
    return scene;
}

Material lambert(float albedo)
{
    Material m;
    m.base_color = glm::vec4(albedo, albedo, albedo, 1.0f);
    m.metallic = 0.0f;
    m.specular = 0.0f; // no interface: nothing is reflected
    return m;
}

Material metal(float roughness, float eta)
{
    Material m;
    m.roughness = roughness;
    m.anisotropy_strength = eta != 0.0f ? 0.5f : 0.0f; // FrameDesc overrides any nonzero value
    return m;
}

View view_from(const glm::vec3& direction, float half_extent)
{
    View v = make_view(glm::normalize(direction) * 2.0f, glm::vec3(0.0f), 0.5f, 1, 1);
    v.orthographic = true;
    v.tan_half_x = v.tan_half_y = half_extent;
    v.znear = 0.0f, v.zfar = 4.0f;
    return v;
}

FrameDesc desc_of(int width, int height, const View& view)
{
    FrameDesc d;
    d.width = width, d.height = height, d.view = view;
    d.msaa = 1;
    return d;
}

Frame render_reference(const Stage& stage, const FrameDesc& desc, const ReferenceOptions& options)
{
    const RenderInput input = stage.input();
    ReferenceOptions o = options;
    if (o.isa == Isa::scalar)
        o.isa = best_isa();
    Result<std::unique_ptr<Renderer>> renderer = make_reference_renderer(input, o);
    EXPECT_TRUE(renderer);
    Result<Frame> frame = (*renderer)->render(desc);
    EXPECT_TRUE(frame) << (frame ? "" : frame.error().line());
    return std::move(*frame);
}

Estimate estimate(const Frame& frame)
{
    Estimate e;
    const std::size_t n = frame.color.bytes.size() / sizeof(float);
    double variance = 0.0;
    for (std::size_t i = 0; i < n; i += 3) { // channels of a pixel share their samples: their deviations add
        double deviation = 0.0;
        for (std::size_t c = i; c < i + 3; ++c) {
            e.mean += static_cast<double>(frame.color.f32()[c]);
            deviation += std::sqrt(static_cast<double>(frame.variance.f32()[c]));
        }
        variance += deviation * deviation;
    }
    e.mean /= static_cast<double>(n);
    e.deviation = std::sqrt(variance) / static_cast<double>(n);
    return e;
}

glm::dvec3 colour_of(const Frame& frame)
{
    glm::dvec3 sum(0.0);
    const int count = frame.color.width * frame.color.height;
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c)
            sum[c] += static_cast<double>(frame.color.f32()[i * frame.color.channels + c]);
    return sum / static_cast<double>(count);
}

double mean_of(const Frame& frame)
{
    double sum = 0.0;
    const std::size_t n = frame.color.bytes.size() / sizeof(float);
    for (std::size_t i = 0; i < n; ++i)
        sum += static_cast<double>(frame.color.f32()[i]);
    return sum / static_cast<double>(n);
}

ChannelEstimate estimate_channels(const Frame& frame)
{
    ChannelEstimate e;
    const std::size_t pixels = static_cast<std::size_t>(frame.color.width) * static_cast<std::size_t>(frame.color.height);
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
        const int c = static_cast<int>(i % 3);
        e.mean[c] += static_cast<double>(frame.color.f32()[i]) / static_cast<double>(pixels);
        e.deviation[c] += static_cast<double>(frame.variance.f32()[i]);
    }
    e.deviation = glm::sqrt(e.deviation) / static_cast<double>(pixels);
    return e;
}

} // namespace burnish::test
