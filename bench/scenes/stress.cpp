#include "bench/scenes/stress.h"

#include <algorithm>
#include <cmath>

#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

// A fixed random sequence in [0, 1) (Steele et al. 2014: SplitMix64).
class Numbers {
  public:
    double next()
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    double between(double a, double b) { return a + (b - a) * next(); }

  private:
    std::uint64_t state_ = 1;
};

Material metal()
{
    Material m;
    m.base_color = glm::vec4(0.9f, 0.85f, 0.8f, 1.0f);
    m.roughness = 0.4f;
    m.anisotropy_strength = 0.6f;
    m.double_sided = true;
    return m;
}

// Adds a noise texture. Each channel is from `least` to 255, so that roughness stays above 0 and normals point
// outwards.
std::int32_t add_texture(Scene& scene, int side, int least, Numbers& numbers)
{
    Image image = make_image(side, side, 4, PixelType::u8);
    for (std::byte& b : image.bytes)
        b = static_cast<std::byte>(numbers.between(least, 255.999));
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = static_cast<std::int32_t>(scene.images.size() - 1);
    scene.textures.push_back(texture);
    return static_cast<std::int32_t>(scene.textures.size() - 1);
}

// Places the scene's primitives at the origin.
void place(Scene& scene, const char* name)
{
    add_node(scene, name, add_mesh(scene, name, 0), glm::mat4(1.0f));
}

SurfacePoint facing(double x, double y, double z)
{
    SurfacePoint p;
    p.position = {x, y, z};
    p.normal = {0.0, 0.0, 1.0};
    p.tangent = {1.0, 0.0, 0.0};
    return p;
}

// Adds a sheet of columns x rows quads at z = 0 from (-x, -y) to (x, y). Textures repeat `times` over its height.
void add_sheet(Scene& scene, int columns, int rows, double x, double y, double times)
{
    add_grid(scene, columns, rows, [=](int column, int row) {
        const double u = 2.0 * column / columns - 1.0, v = 2.0 * row / rows - 1.0;
        SurfacePoint p = facing(u * x, v * y, 0.0);
        p.u = 0.5 * times * u * x / y, p.v = 0.5 * times * v;
        return p;
    });
}

constexpr double kBeyond = 1.003; // relative to the image's half height: slightly more than bench_view() sees at z = 0

} // namespace

Scene make_textured(std::int64_t textures, double aspect)
{
    Scene scene;
    Numbers numbers;
    Material m = metal();
    TextureRef* const refs[] = {&m.base_color_tex, &m.normal_tex, &m.metallic_roughness_tex, &m.occlusion_tex, &m.anisotropy_tex};
    for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(textures), std::size(refs)); ++i)
        refs[i]->texture = add_texture(scene, 512, 96, numbers);
    if (textures > 5) { // zero heights make every ray march to the end
        m.height_tex.texture = add_texture(scene, 512, 0, numbers);
        std::fill(scene.images.back().bytes.begin(), scene.images.back().bytes.end(), std::byte{0});
    }
    scene.materials.push_back(m);
    begin_primitive(scene, 0);
    add_sheet(scene, 64, 36, kBeyond * aspect, kBeyond, 2.0);
    place(scene, "textured");
    return scene;
}

Scene make_floor()
{
    constexpr int kQuads = 64;
    Scene scene;
    Numbers numbers;
    Material m = metal();
    for (TextureRef* ref : {&m.base_color_tex, &m.normal_tex, &m.metallic_roughness_tex})
        ref->texture = add_texture(scene, 512, 96, numbers);
    scene.materials.push_back(m);
    begin_primitive(scene, 0);
    add_grid(scene, kQuads, kQuads, [](int column, int row) { // front faces look up: columns run right, rows away
        const double x = 40.0 * (static_cast<double>(column) / kQuads - 0.5), away = 20.0 * row / kQuads;
        SurfacePoint p;
        p.position = {x, -0.3, 1.0 - away};
        p.normal = {0.0, 1.0, 0.0};
        p.tangent = {1.0, 0.0, 0.0};
        p.u = 2.0 * x, p.v = 2.0 * away;
        return p;
    });
    place(scene, "floor");
    return scene;
}

Scene make_foliage(std::int64_t quads, double aspect, bool opaque)
{
    constexpr int kSide = 64; // texels; a leaf is a disc
    Scene scene;
    Numbers numbers;
    Image image = make_image(kSide, kSide, 4, PixelType::u8);
    for (int y = 0, at = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x, at += 4) {
            const double dx = (x + 0.5) / kSide - 0.5, dy = (y + 0.5) / kSide - 0.5;
            const int rgba[4] = {60, 120 + x, 40, dx * dx + dy * dy < 0.2 ? 255 : 0};
            for (int c = 0; c < 4; ++c)
                image.bytes[static_cast<std::size_t>(at + c)] = static_cast<std::byte>(rgba[c]);
        }
    scene.images.push_back(std::move(image));
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    Material m = metal();
    m.metallic = 0.0f;
    m.base_color_tex.texture = 0;
    m.alpha_mode = opaque ? AlphaMode::opaque : AlphaMode::mask;
    scene.materials.push_back(m);
    begin_primitive(scene, 0);
    for (std::int64_t i = 0; i < quads; ++i) {
        const double x = numbers.between(-aspect, aspect), y = numbers.between(-1.0, 1.0), z = numbers.between(-0.5, 0.0);
        const double turn = numbers.between(0.0, 6.283), side = 0.015;
        add_grid(scene, 1, 1, [=](int column, int row) {
            const double u = 2 * column - 1, v = 2 * row - 1;
            SurfacePoint p = facing(x + side * (u * std::cos(turn) - v * std::sin(turn)),
                                    y + side * (u * std::sin(turn) + v * std::cos(turn)), z + 0.5 * side * u);
            p.u = column, p.v = row;
            return p;
        });
    }
    place(scene, "foliage");
    return scene;
}

Scene make_slivers(std::int64_t triangles, double aspect)
{
    Scene scene;
    Numbers numbers;
    Material m;
    m.unlit = m.double_sided = true;
    scene.materials.push_back(m);
    begin_primitive(scene, 0);
    // at 1920x1080 a unit is 540 pixels: 3.3 pixels wide at one end, a thousand long
    constexpr double kWidth = 0.0061, kLength = 1.93;
    for (std::int64_t i = 0; i < triangles; ++i) {
        const double turn = 0.785398 + numbers.between(-0.2, 0.2), x = numbers.between(-0.6 * aspect, 0.6 * aspect);
        const double y = numbers.between(-0.3, 0.3), z = numbers.between(-0.02, 0.0);
        const double dx = 0.5 * kLength * std::cos(turn), dy = 0.5 * kLength * std::sin(turn), w = 0.5 * kWidth;
        add_grid(scene, 1, 1, [=](int column, int row) { // two corners coincide: one triangle
            if (column == 0)
                return facing(x - dx, y - dy, z);
            const double side = row ? w : -w;
            return facing(x + dx - side * dy / kLength, y + dy + side * dx / kLength, z);
        });
    }
    place(scene, "slivers");
    return scene;
}

Scene make_lit(std::int64_t lights, double aspect)
{
    Scene scene;
    scene.materials.push_back(metal());
    begin_primitive(scene, 0);
    add_sheet(scene, 64, 36, kBeyond * aspect, kBeyond, 1.0);
    place(scene, "lit");
    const bool few = lights <= 4; // few lights reach everywhere; of more, about four reach a point
    const int columns = few ? 2 : static_cast<int>(std::lround(std::sqrt(static_cast<double>(lights) * 2.0)));
    for (int i = 0; i < static_cast<int>(lights); ++i) {
        Light light;
        light.color = glm::vec3(1.0f, 0.9f, 0.8f);
        light.intensity = 0.3f;
        const int rows = (static_cast<int>(lights) + columns - 1) / columns;
        const double spacing_x = 2.0 * aspect / columns, spacing_y = 2.0 / rows, height = 0.1;
        light.range = few ? 10.0f : static_cast<float>(std::hypot(std::sqrt(spacing_x * spacing_y * 4.0 / 3.14159265), height));
        scene.lights.push_back(light);
        Node node;
        node.light = i;
        node.local[3] = glm::vec4((i % columns + 0.5) * spacing_x - aspect, (i / columns + 0.5) * spacing_y - 1.0, height, 1.0);
        scene.nodes.push_back(node);
    }
    return scene;
}

Scene make_crowd(std::int64_t triangles)
{
    Scene scene;
    Material m;
    m.unlit = true;
    scene.materials.push_back(m);
    begin_primitive(scene, 0);
    const int rows = std::max(1, static_cast<int>(std::lround(std::sqrt(0.5 * static_cast<double>(triangles)))));
    add_sheet(scene, rows, rows, 0.11, 0.11, 1.0); // 120 pixels at 1920x1080
    place(scene, "crowd");
    return scene;
}

Scene make_many_materials(std::int64_t materials, double aspect)
{
    constexpr int kColumns = 256, kRows = 144;
    Scene scene;
    for (std::int64_t i = 0; i < materials; ++i) {
        scene.materials.push_back(metal());
        scene.materials.back().roughness = 0.2f + 0.6f * static_cast<float>(i) / static_cast<float>(materials);
    }
    for (std::int64_t i = 0; i < materials; ++i) { // a primitive each, with quads all over the image
        begin_primitive(scene, static_cast<std::int32_t>(i));
        for (std::int64_t quad = i; quad < kColumns * kRows; quad += materials) {
            const double x0 = static_cast<double>(quad % kColumns), y0 = static_cast<double>(quad / kColumns);
            add_grid(scene, 1, 1, [=](int column, int row) {
                return facing((2.0 * (x0 + column) / kColumns - 1.0) * kBeyond * aspect, (2.0 * (y0 + row) / kRows - 1.0) * kBeyond, 0.0);
            });
        }
    }
    place(scene, "materials");
    return scene;
}

} // namespace burnish
