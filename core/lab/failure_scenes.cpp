#include "core/lab/failure_scenes.h"

#include <cmath>
#include <limits>

#include "core/math/scalar_math.h"
#include "core/scene/area_light.h"
#include "core/scene/builtin/surface.h"
#include "core/scene/texture.h"

namespace burnish {
namespace {

constexpr double kHalf = 0.2; // half a plate's side, metres
const glm::vec3 kSilver(0.97f, 0.96f, 0.91f), kBlue(0.1f, 0.2f, 0.75f), kRed(0.85f, 0.12f, 0.08f);

std::uint32_t begin(Scene& scene, Material material)
{
    material.name = "trial";
    material.double_sided = true;
    scene.materials.push_back(std::move(material));
    return begin_primitive(scene, static_cast<std::int32_t>(scene.materials.size()) - 1);
}

void end(Scene& scene, std::uint32_t first, const glm::mat4& local = glm::mat4(1.0f))
{
    add_node(scene, "trial", add_mesh(scene, "trial", first), local);
}

// Adds a sheet with `squares` squares to a side. height(): metres at texture coordinates. uv(): the coordinates for a
// point of the sheet.
template <class Height, class Coordinates> void add_sheet(Scene& scene, int squares, const Height& height, const Coordinates& uv)
{
    add_grid(scene, squares, squares, [&](int column, int row) {
        const double u = static_cast<double>(column) / squares, v = 1.0 - static_cast<double>(row) / squares, step = 1e-3;
        const glm::dvec2 at = uv(u, v);
        SurfacePoint p;
        p.position = {kHalf * (2.0 * u - 1.0), kHalf * (1.0 - 2.0 * v), height(u, v)};
        p.normal = {(height(u - step, v) - height(u + step, v)) / (4.0 * step * kHalf),
                    (height(u, v + step) - height(u, v - step)) / (4.0 * step * kHalf), 1.0};
        p.tangent = {1.0, 0.0, 0.0};
        p.u = at.x, p.v = at.y;
        return p;
    });
}

constexpr auto level = [](double, double) { return 0.0; };
constexpr auto plain = [](double u, double v) { return glm::dvec2(u, v); };

Scene plate_of(Material material)
{
    Scene scene;
    const std::uint32_t first = begin(scene, std::move(material));
    add_sheet(scene, 16, level, plain);
    end(scene, first);
    return scene;
}

constexpr double kPlace = 0.1; // metres along z, for both plates

// Makes a red plate `gap` metres in front of a blue one.
Scene make_plates(double gap)
{
    Scene scene;
    for (const bool behind : {false, true}) {
        const std::uint32_t first = begin(scene, brushed_metal(0.4, 0.0, behind ? kBlue : kRed));
        add_sheet(scene, behind ? 7 : 3, level, plain);
        glm::mat4 local(behind ? 0.9f : 1.0f); // hidden behind the other plate
        local[3] = glm::vec4(0.0f, 0.0f, static_cast<float>(kPlace - (behind ? gap : 0.0)), 1.0f);
        end(scene, first, local);
    }
    return scene;
}

// Makes a star of triangles, `width` metres wide at their feet.
Scene make_needles(double width)
{
    constexpr int kCount = 20;
    Scene scene;
    const std::uint32_t first = begin(scene, brushed_metal(0.4, 0.0, kSilver));
    for (int i = 0; i < kCount; ++i) {
        const double turn = 2.0 * kPi * (i + 0.3) / kCount;
        const glm::dvec3 along(det_cos(turn), det_sin(turn), 0.0), across(-along.y, along.x, 0.0);
        add_grid(scene, 1, 1, [&](int column, int row) {
            SurfacePoint p; // the two upper corners coincide
            p.position = row ? along * kHalf : along * (0.2 * kHalf) + across * (width * (column - 0.5));
            p.normal = {0.0, 0.0, 1.0};
            p.tangent = along;
            return p;
        });
    }
    end(scene, first);
    return scene;
}

// Makes brushed metal whose grain rotates by half a turn about four points, in a map with `texels` texels to a side.
// The encoded direction flips along a line between the points: d beside -d.
Scene make_cores(double texels)
{
    const int side = static_cast<int>(std::lround(texels));
    Scene scene = plate_of(brushed_metal(0.3, 0.9, kSilver));
    scene.materials[0].anisotropy_tex.texture = add_texture(scene, "flow", map_of(side, side, [](double u, double v) {
                                                                const double a =
                                                                    0.5 * det_atan2(det_sin(2.0 * kPi * v), det_sin(2.0 * kPi * u));
                                                                return glm::dvec3(0.5 + 0.5 * det_cos(a), 0.5 + 0.5 * det_sin(a), 1.0);
                                                            }));
    return scene;
}

// Makes a plate with map normals that lean by `degrees`.
Scene make_leaning(double degrees)
{
    const double lean = degrees * kPi / 180.0, turn = 0.4;
    Image normals = make_image(4, 4, 3, PixelType::f32);
    for (int i = 0; i < 16; ++i) {
        normals.f32()[3 * i] = static_cast<float>(0.5 + 0.5 * det_sin(lean) * det_cos(turn));
        normals.f32()[3 * i + 1] = static_cast<float>(0.5 + 0.5 * det_sin(lean) * det_sin(turn));
        normals.f32()[3 * i + 2] = static_cast<float>(0.5 + 0.5 * det_cos(lean));
    }
    Scene scene = plate_of(brushed_metal(0.35, 0.7, kSilver));
    scene.materials[0].normal_tex.texture = add_texture(scene, "leaning", std::move(normals));
    return scene;
}

// Makes roofs over texel strips, red on one side and blue on the other, with this slope.
Scene make_roofs(double slope)
{
    const auto left = [](double u) { return std::fmod(u * 128.0, 1.0) < 0.5; };
    Material paint;
    paint.metallic = 0.0f, paint.roughness = 0.8f;
    Scene scene = plate_of(paint);
    scene.materials[0].base_color_tex.texture = add_texture(
        scene, "sides", map_of(512, 4, [&](double u, double) { return left(u) ? glm::dvec3(0.9, 0.25, 0.2) : glm::dvec3(0.2, 0.3, 0.9); }));
    scene.materials[0].normal_tex.texture = add_texture(scene, "roofs", map_of(512, 4, [&](double u, double) {
                                                            return normal_colour({left(u) ? slope : -slope, 0.0});
                                                        }));
    return scene;
}

double wave(double u, double v) // [0,1]
{
    return 0.5 + 0.5 * det_sin(2.0 * kPi * 3.0 * u) * det_sin(2.0 * kPi * 3.0 * v);
}

// Makes waves as a height map. `depth` is in lengths of texture coordinates. make_waves() makes them as triangles.
Scene make_parallax_waves(double depth)
{
    Scene scene = plate_of(brushed_metal(0.35, 0.0, kSilver));
    const double steep = depth * 2.0 * kPi * 3.0 * 0.5; // largest slope of a wave
    scene.materials[0].height_tex.texture =
        add_texture(scene, "heights", map_of(256, 256, [](double u, double v) { return glm::dvec3(wave(u, v)); }));
    scene.materials[0].normal_tex.texture =
        add_texture(scene, "slopes", map_of(256, 256, [&](double u, double v) {
                        const double a = 2.0 * kPi * 3.0 * u, b = 2.0 * kPi * 3.0 * v;
                        return normal_colour({steep * det_cos(a) * det_sin(b), -steep * det_sin(a) * det_cos(b)});
                    }));
    scene.materials[0].base_color_tex.texture =
        add_texture(scene, "crests", map_of(256, 256, [](double u, double v) {
                        return glm::mix(glm::dvec3(0.15, 0.2, 0.5), glm::dvec3(0.95, 0.8, 0.5), smooth_step(0.35, 0.65, wave(u, v)));
                    }));
    scene.materials[0].height_scale = static_cast<float>(depth);
    return scene;
}

Scene make_waves(double depth)
{
    Scene scene;
    Material material = make_parallax_waves(depth).materials[0];
    const Scene flat = make_parallax_waves(depth);
    material.height_tex = material.normal_tex = TextureRef();
    material.base_color_tex.texture = add_texture(scene, "crests", flat.images[2]);
    const std::uint32_t first = begin(scene, material);
    add_sheet(
        scene, 160, [&](double u, double v) { return 2.0 * kHalf * depth * (wave(u, v) - 1.0); }, plain);
    end(scene, first);
    return scene;
}

// Makes the same height map with its coordinates `times` as long along one side.
Scene make_stretched(double times)
{
    Scene scene = make_parallax_waves(0.08), out;
    out.materials = scene.materials, out.textures = scene.textures, out.images = scene.images;
    const std::uint32_t first = begin_primitive(out, 0);
    add_sheet(out, 16, level, [&](double u, double v) { return glm::dvec2(u * times, v / times); });
    end(out, first);
    return out;
}

// Makes brass and blue squares at coordinates that begin at `from`.
Scene make_far_texels(double from)
{
    Scene scene;
    Material material = brushed_metal(0.4, 0.0, glm::vec3(1.0f));
    material.base_color_tex.texture = add_texture(scene, "squares", map_of(16, 16, [](double u, double v) {
                                                      return (static_cast<int>(u * 16.0) + static_cast<int>(v * 16.0)) % 2
                                                                 ? glm::dvec3(0.95, 0.8, 0.5)
                                                                 : glm::dvec3(0.1, 0.2, 0.8);
                                                  }));
    const std::uint32_t first = begin(scene, material);
    add_sheet(scene, 16, level, [&](double u, double v) { return glm::dvec2(std::round(from) + u, std::round(from) + v); });
    end(scene, first);
    return scene;
}

// Makes an image `width` texels wide, viewed across 64 of its stripes.
Scene make_wide_texels(double width)
{
    const int texels = 2 * static_cast<int>(std::lround(0.5 * width)); // an even width keeps the stripes aligned
    Scene scene;
    Material material = brushed_metal(0.4, 0.0, glm::vec3(1.0f));
    material.base_color_tex.texture =
        add_texture(scene, "stripes", map_of(texels, 1, [&](double u, double) {
                        return static_cast<int>(u * texels) % 2 ? glm::dvec3(0.95, 0.8, 0.5) : glm::dvec3(0.1, 0.2, 0.8);
                    }));
    const std::uint32_t first = begin(scene, material);
    add_sheet(scene, 16, level, [&](double u, double v) { return glm::dvec2(1.0 + (u - 0.5) * 64.0 / texels, v); });
    end(scene, first);
    return scene;
}

// Makes a ball of rough glass with this index. `inside` makes a sheet of glass in its place, seen from within the
// glass.
Scene glass_of(double index, bool inside)
{
    Material glass;
    glass.metallic = 0.0f, glass.transmission = 1.0f, glass.roughness = 0.2f;
    glass.ior = static_cast<float>(index);
    Scene scene;
    const std::uint32_t first = begin(scene, glass);
    if (!inside)
        add_sphere(scene, 48, 24, kHalf);
    else
        add_grid(scene, 16, 16, [](int column, int row) {
            SurfacePoint p; // columns go left
            p.position = {kHalf * (1.0 - column / 8.0), kHalf * (row / 8.0 - 1.0), 0.0};
            p.normal = {0.0, 0.0, -1.0};
            p.tangent = {-1.0, 0.0, 0.0};
            return p;
        });
    end(scene, first);
    return scene;
}

Scene make_glass_ball(double index)
{
    return glass_of(index, false);
}

Scene make_inside_glass(double index)
{
    return glass_of(index, true);
}

// Makes `count` faces to a side, each showing one tile of an image up to its edge. The lower half is red, the upper
// half blue.
Scene make_tiles(double count)
{
    const int side = static_cast<int>(std::lround(count));
    Scene scene;
    Material material = brushed_metal(0.4, 0.0, glm::vec3(1.0f));
    material.base_color_tex.texture =
        add_texture(scene, "tiles",
                    map_of(256, 256, [&](double u, double) { return u < 0.5 ? glm::dvec3(0.9, 0.25, 0.2) : glm::dvec3(0.2, 0.3, 0.9); }));
    const std::uint32_t first = begin(scene, material);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            add_grid(scene, 1, 1, [&](int column, int row) {
                SurfacePoint p;
                p.position = {kHalf * (2.0 * (x + column) / side - 1.0), kHalf * (2.0 * (y + row) / side - 1.0), 0.0};
                p.normal = {0.0, 0.0, 1.0};
                p.tangent = {1.0, 0.0, 0.0};
                p.u = 0.5 * (y < side / 2) + 0.5 * column, p.v = row;
                return p;
            });
    end(scene, first);
    return scene;
}

// Makes a float image with this share of NaN texels.
Scene make_no_numbers(double share)
{
    Image image = make_image(64, 64, 3, PixelType::f32);
    for (int i = 0; i < 64 * 64; ++i)
        for (int c = 0; c < 3; ++c)
            image.f32()[3 * i + c] = noise(i % 64, i / 64, 7u) < share ? std::numeric_limits<float>::quiet_NaN() : kSilver[c];
    Scene scene = plate_of(brushed_metal(0.4, 0.0, glm::vec3(1.0f)));
    scene.materials[0].base_color_tex.texture = add_texture(scene, "no numbers", std::move(image));
    return scene;
}

// Makes a small white square before a plate with this radiance.
Scene make_gloom(double radiance)
{
    Scene scene;
    for (const bool white : {false, true}) {
        Material material;
        material.metallic = 0.0f, material.unlit = true;
        material.base_color = glm::vec4(glm::vec3(white ? 1.0f : static_cast<float>(radiance)), 1.0f);
        const std::uint32_t first = begin(scene, material);
        add_sheet(scene, 3, level, plain);
        glm::mat4 local(white ? 0.3f : 1.0f);
        local[3] = glm::vec4(0.0f, 0.0f, white ? 0.01f : 0.0f, 1.0f);
        end(scene, first, local);
    }
    return scene;
}

Material mirror()
{
    return brushed_metal(0.05, 0.0, kSilver);
}

// Makes a mirror that bulges by a normal map, with this slope at its sides. Texels are larger than pixels and reach
// from edge to edge.
Scene make_bulge(double slope)
{
    constexpr int kSide = 32;
    Image normals = make_image(kSide, kSide, 3, PixelType::f32);
    for (int i = 0; i < kSide * kSide; ++i) {
        const double last = kSide - 1, x = slope * (2.0 * (i % kSide) / last - 1.0), y = slope * (1.0 - 2.0 * (i / kSide) / last);
        const glm::dvec3 n = glm::normalize(glm::dvec3(x, y, 1.0));
        for (int c = 0; c < 3; ++c)
            normals.f32()[3 * i + c] = static_cast<float>(0.5 + 0.5 * n[c]);
    }
    Scene scene;
    const std::uint32_t first = begin(scene, mirror());
    add_sheet(scene, 16, level, [](double u, double v) { return (0.5 + (kSide - 1.0) * glm::dvec2(u, v)) / double(kSide); });
    end(scene, first);
    scene.materials[0].normal_tex.texture = add_texture(scene, "bulge", std::move(normals));
    return scene;
}

// Makes the bulging mirror by vertex normals.
Scene make_dome(double slope)
{
    Scene scene;
    const std::uint32_t first = begin(scene, mirror());
    add_grid(scene, 16, 16, [&](int column, int row) {
        const double x = column / 8.0 - 1.0, y = row / 8.0 - 1.0;
        SurfacePoint p;
        p.position = {kHalf * x, kHalf * y, 0.0};
        p.normal = {slope * x, slope * y, 1.0};
        p.tangent = {1.0, 0.0, 0.0};
        return p;
    });
    end(scene, first);
    return scene;
}

// Makes a plate and an upright lamp across it. The lamp's middle is `height` metres above the plate, or below it for
// negative heights.
Scene make_sinking_lamp(double height)
{
    constexpr float kWide = 0.12f, kTall = 0.1f; // half sides
    Scene scene = plate_of(brushed_metal(0.5, 0.6, kSilver));
    const float y = static_cast<float>(1.1 * kHalf), h = static_cast<float>(height);
    AreaLight lamp;
    lamp.shape = AreaShape::quad, lamp.radiance = glm::vec3(8.0f, 7.5f, 6.5f);
    lamp.points = {{-kWide, y, h - kTall}, {kWide, y, h - kTall}, {kWide, y, h + kTall}, {-kWide, y, h + kTall}};
    add_area_light(scene, lamp);
    return scene;
}

} // namespace

const std::vector<ParametricScene>& failure_scenes()
{
    static const std::vector<ParametricScene> scenes = {
        {{"plates", "two plates, so many metres apart"}, 0.01, 0.0, 1.0, make_plates},
        {{"needles", "triangles so many metres wide at their feet"}, 0.02, 1e-6, 0.06, make_needles},
        {{"leaning", "a normal map whose normals lean by so many degrees"}, 30.0, 0.0, 180.0, make_leaning},
        {{"cores", "an anisotropy direction that turns about four places, so many texels to a side"}, 256.0, 4.0, 1024.0, make_cores},
        {{"roofs", "strips with red and blue sides, of this slope"}, 0.5, 0.0, 10.0, make_roofs},
        {{"relief", "waves in a height map, so many texture lengths deep"}, 0.1, 0.0, 1.0, make_parallax_waves},
        {{"waves", "waves made of triangles, so many texture lengths deep"}, 0.1, 0.0, 1.0, make_waves},
        {{"stretched", "a height map, so many times as long one way as the other"}, 2.0, 1.0, 100.0, make_stretched},
        {{"far-texels", "texture coordinates so far from zero"}, 0.0, 0.0, 1e7, make_far_texels},
        {{"wide-texels", "64 stripes of a picture with so many stripes"}, 256.0, 64.0, 16384.0, make_wide_texels},
        {{"glass-ball", "a ball of rough glass with this index of refraction"}, 1.5, 1.0, 10.0, make_glass_ball},
        {{"inside-glass", "the inner face of rough glass with this index of refraction"}, 1.5, 1.0, 10.0, make_inside_glass},
        {{"tiles", "so many faces to a side, each with half a picture"}, 8.0, 1.0, 256.0, make_tiles},
        {{"no-numbers", "a float picture with this share of NaN texels"}, 0.01, 0.0, 1.0, make_no_numbers},
        {{"bulge", "a mirror that bulges by a normal map, with this slope at its sides"}, 0.05, 0.0, 1.0, make_bulge},
        {{"dome", "a mirror that bulges by vertex normals, with this slope at its sides"}, 0.05, 0.0, 1.0, make_dome},
        {{"sinking-lamp", "a plate under a lamp so many metres above it"}, 0.1, -0.2, 1.0, make_sinking_lamp},
        {{"gloom", "a white square on a plate with this radiance"}, 0.1, 0.0, 1.0, make_gloom},
    };
    return scenes;
}

} // namespace burnish
