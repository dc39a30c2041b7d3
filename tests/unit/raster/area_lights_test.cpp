// Area lights on a surface, by the tile renderer: exact properties, and each evaluation method against the others.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "core/scene/area_light.h"
#include "shading/bake/ltc/shipped.h"
#include "shading/bake/mip/light_picture.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

AreaLight area_light_of(AreaShape shape, const std::vector<glm::vec3>& points, float radius = 0.0f)
{
    AreaLight light;
    light.shape = shape, light.points = points, light.radius = radius;
    light.radiance = glm::vec3(3.0f, 2.0f, 1.0f);
    return light;
}

// Returns one light of each shape, all above a plate in the plane z = 0. The quad reaches below the plate's horizon.
std::vector<AreaLight> each_area_light()
{
    return {area_light_of(AreaShape::quad, {{-1.5f, 1.0f, -0.3f}, {1.0f, 1.2f, -0.3f}, {1.0f, 1.2f, 1.0f}, {-1.5f, 1.0f, 1.0f}}),
            area_light_of(AreaShape::polygon, {{0.2f, 0.0f, 0.8f}, {0.1f, 0.5f, 0.9f}, {-0.5f, 0.1f, 0.9f}}),
            area_light_of(AreaShape::disk, {{0.3f, -0.3f, 1.0f}, {0.3f, 0.2f, 1.0f}, {0.6f, -0.3f, 1.1f}}),
            area_light_of(AreaShape::sphere, {{-0.4f, -0.2f, 0.6f}}, 0.2f),
            area_light_of(AreaShape::line, {{-0.8f, 0.1f, 0.4f}, {0.7f, 0.3f, 0.9f}}, 0.01f)};
}

FrameDesc desc_of_plate(const glm::vec3& eye, float roughness, float eta)
{
    FrameDesc d;
    d.width = d.height = 16, d.msaa = 1, d.background = false;
    d.view = make_view(eye, {0, 0, 0}, 0.5f, d.width, d.height);
    d.technique = "bent_normal";
    d.roughness = roughness, d.anisotropy = eta, d.override_anisotropy = true;
    return d;
}

const glm::vec3 kPlateEyes[] = {{0.2f, -0.5f, 2.0f}, {1.2f, -1.0f, 0.9f}};

class LitPlate {
  public:
    explicit LitPlate(float metallic) : stage_(plate(metallic), 0.0f) {}
    void light(const std::vector<AreaLight>& lights, const glm::mat4& world = glm::mat4(1.0f))
    {
        stage_.tables.area_lights.clear();
        for (const AreaLight& light : lights)
            stage_.tables.area_lights.push_back(*place_area_light(light, world));
    }
    // Makes `image` the texture 0 of all lights. Returns the image as shading reads it.
    LightPicture hang(Image image)
    {
        Texture texture;
        texture.image = static_cast<std::int32_t>(stage_.scene.images.size());
        stage_.scene.textures.assign(1, texture);
        stage_.scene.images.push_back(std::move(image));
        return make_light_picture(stage_.scene.images.back());
    }
    Image seen(const FrameDesc& d) const
    {
        if (!ltc)
            return stage_.render(d, best_isa()).color;
        SessionParts parts = stage_.parts();
        parts.ltc = ltc;
        SessionOptions options;
        options.isa = best_isa();
        Result<Session> session = Session::make(parts, options);
        EXPECT_TRUE(session);
        return session->render(d)->color;
    }
    std::shared_ptr<const ltc::ShadingTables> ltc; // none: the program's own

  private:
    Stage stage_;
};

double mean_radiance(const Image& image)
{
    double sum = 0.0;
    const std::size_t n = image.bytes.size() / sizeof(float);
    for (std::size_t i = 0; i < n; ++i)
        sum += static_cast<double>(image.f32()[i]) / static_cast<double>(n);
    return sum;
}

double most_difference(const Image& a, const Image& b)
{
    double most = 0.0;
    for (std::size_t i = 0; i < a.bytes.size() / sizeof(float); ++i)
        most = std::max(most, std::abs(static_cast<double>(a.f32()[i]) - static_cast<double>(b.f32()[i])));
    return most;
}

int way_named(const std::string& name)
{
    for (std::size_t i = 0; i < area_ways().size(); ++i)
        if (name == area_ways()[i].name)
            return static_cast<int>(i);
    ADD_FAILURE() << name;
    return 0;
}

TEST(area_lights, two_quads_that_make_up_one_are_that_one)
{
    const glm::vec3 a(-0.5f, 0.6f, 0.2f), b(0.7f, 0.5f, 0.2f), c(0.7f, 0.7f, 1.0f), e(-0.5f, 0.8f, 1.0f);
    const glm::vec3 below = 0.5f * (a + b), above = 0.5f * (e + c);
    for (const float metallic : {0.0f, 1.0f})
        for (const glm::vec3& eye : kPlateEyes) {
            LitPlate room(metallic);
            const FrameDesc d = desc_of_plate(eye, 0.5f, 0.7f);
            room.light({area_light_of(AreaShape::quad, {a, e, c, b})});
            const Image whole = room.seen(d);
            room.light({area_light_of(AreaShape::quad, {a, e, above, below}), area_light_of(AreaShape::quad, {below, above, c, b})});
            EXPECT_GT(mean_radiance(whole), 1e-4);
            EXPECT_LT(most_difference(whole, room.seen(d)), 1e-6 * 3.0);
        }
}

TEST(area_lights, a_quad_is_a_polygon_of_four_corners)
{
    LitPlate room(1.0f);
    const FrameDesc d = desc_of_plate(kPlateEyes[0], 0.4f, 0.6f);
    AreaLight quad = each_area_light()[0];
    room.light({quad});
    const Image as_quad = room.seen(d);
    quad.shape = AreaShape::polygon;
    room.light({quad});
    EXPECT_EQ(most_difference(as_quad, room.seen(d)), 0.0);
    EXPECT_GT(mean_radiance(as_quad), 1e-3);
}

TEST(area_lights, of_one_side_are_dark_from_behind)
{
    for (const char* way : {"ltc", "ltc-clipless", "mc"})
        for (const std::size_t which : {1u, 2u}) {
            LitPlate room(0.0f);
            FrameDesc d = desc_of_plate(kPlateEyes[0], 0.5f, 0.0f);
            d.area_way = way_named(way);
            AreaLight light = each_area_light()[which];
            room.light({light});
            const bool shines = place_area_light(light, glm::mat4(1.0f))->normal.z < 0.0f; // onto the plate, from above
            EXPECT_EQ(mean_radiance(room.seen(d)) > 0.0, shines) << way << " " << which;
            std::reverse(light.points.begin() + 1, light.points.end());
            room.light({light});
            EXPECT_NE(mean_radiance(room.seen(d)) > 0.0, shines) << way << " " << which;
            light.two_sided = true;
            room.light({light});
            EXPECT_GT(mean_radiance(room.seen(d)), 1e-3) << way << " " << which;
        }
}

// A mirrored node reverses the order of the points and keeps the side that shines. A scaled node scales the light.
TEST(area_lights, go_with_their_nodes)
{
    const AreaLight quad = area_light_of(AreaShape::quad, {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}});
    glm::mat4 mirrored(1.0f);
    mirrored[0][0] = -1.0f;
    EXPECT_EQ(place_area_light(quad, mirrored)->normal, glm::vec3(0, 0, 1));
    glm::mat4 wide(1.0f);
    wide[1][1] = 3.0f;
    EXPECT_FLOAT_EQ(place_area_light(quad, wide)->area, 3.0f);
    EXPECT_FLOAT_EQ(place_area_light(area_light_of(AreaShape::sphere, {{0, 0, 0}}, 0.5f), wide)->radius, 1.5f);
    glm::mat4 flat(1.0f);
    flat[1][1] = 0.0f;
    EXPECT_FALSE(place_area_light(quad, flat));
    // a sheared disc is an ellipse with new axes at right angles
    glm::mat4 sheared(1.0f);
    sheared[1][0] = 1.0f;
    const PlacedAreaLight disk = *place_area_light(area_light_of(AreaShape::disk, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), sheared);
    EXPECT_NEAR(glm::dot(disk.points[1], disk.points[2]), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(disk.points[1]) * glm::length(disk.points[2]), 1.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(disk.points[1], disk.points[1]), 2.618034f, 1e-5f); // from the matrix's larger singular value
    EXPECT_EQ(disk.normal, glm::vec3(0, 0, 1));
}

// Compares the transformed cosine with the lobe's mean over points on the light. They differ by the fit's error, most where the light lies
// in the lobe's tail.
TEST(area_lights, by_cosines_are_what_sampling_finds)
{
    const char* names[] = {"quad", "polygon", "disk", "sphere", "line"};
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.35f, 0.6f, 0.9f})
            for (const float eta : {0.0f, 0.8f})
                for (const glm::vec3& eye : kPlateEyes)
                    for (std::size_t i = 0; i < 5; ++i) {
                        LitPlate room(metallic);
                        AreaLight light = each_area_light()[i];
                        light.two_sided = true;
                        room.light({light});
                        FrameDesc d = desc_of_plate(eye, roughness, eta);
                        const double ltc = mean_radiance(room.seen(d));
                        d.area_way = way_named("ltc-clipless");
                        const double clipless = mean_radiance(room.seen(d));
                        d.area_way = way_named("mc"), d.light_samples = 1024;
                        const double mc = mean_radiance(room.seen(d));
                        const double bound = metallic > 0.0f ? 0.06 * mc + 0.012 : 0.05 * mc;
                        EXPECT_NEAR(ltc, mc, bound)
                            << names[i] << ", metallic " << metallic << ", roughness " << roughness << ", eta " << eta << ", eye " << eye.z;
                        EXPECT_NEAR(clipless, mc, bound + 0.06 * mc) << names[i];
                        std::printf("%s metallic %.0f roughness %.2f eta %.1f eye %.1f: %.4f, ltc %+.2f %%, clipless %+.2f %%\n", names[i],
                                    static_cast<double>(metallic), static_cast<double>(roughness), static_cast<double>(eta),
                                    static_cast<double>(eye.z), mc, 100.0 * (ltc / mc - 1.0), 100.0 * (clipless / mc - 1.0));
                    }
}

TEST(area_lights, of_round_lobes_by_the_round_table_are_what_sampling_finds)
{
    for (const float roughness : {0.35f, 0.6f, 0.9f})
        for (const glm::vec3& eye : kPlateEyes)
            for (AreaLight light : each_area_light()) {
                LitPlate room(1.0f);
                light.two_sided = true;
                room.light({light});
                FrameDesc d = desc_of_plate(eye, roughness, 0.0f);
                d.area_way = way_named("ltc-isotropic");
                const double found = mean_radiance(room.seen(d));
                d.area_way = way_named("mc"), d.light_samples = 1024;
                const double mc = mean_radiance(room.seen(d));
                EXPECT_NEAR(found, mc, 0.06 * mc + 0.012) << "roughness " << roughness << ", eye " << eye.z;
            }
}

// With lobes tilted against their surface, no light arrives from below the horizon, and the rest agrees with sampling.
TEST(area_lights, are_cut_at_the_horizon_of_a_surface_whose_lobes_are_tilted)
{
    for (const float metallic : {0.0f, 1.0f})
        for (const glm::vec2& tilt : {glm::vec2(0.5f, 0.0f), glm::vec2(-0.4f, 0.5f)})
            for (const glm::vec3& eye : kPlateEyes)
                for (std::size_t i = 0; i < 5; ++i) {
                    LitPlate room(metallic);
                    AreaLight light = each_area_light()[i];
                    light.two_sided = true;
                    FrameDesc d = desc_of_plate(eye, 0.6f, 0.5f);
                    d.tilt_rad = tilt;
                    const auto found = [&](const char* way) {
                        d.area_way = way_named(way), d.light_samples = 1024;
                        return mean_radiance(room.seen(d));
                    };
                    for (glm::vec3& p : light.points) // half of the light below
                        p.z -= 0.6f;
                    room.light({light});
                    const double ltc = found("ltc"), clipless = found("ltc-clipless"), mc = found("mc");
                    EXPECT_NEAR(ltc, mc, 0.08 * mc + 0.015) << i << " metallic " << metallic << " tilt " << tilt.x << " eye " << eye.z;
                    EXPECT_NEAR(clipless, mc, 0.14 * mc + 0.015) << i;
                    std::printf("%zu metallic %.0f tilt %.1f eye %.1f: %.4f, ltc %+.2f %%\n", i, static_cast<double>(metallic),
                                static_cast<double>(tilt.x), static_cast<double>(eye.z), mc, 100.0 * (ltc / mc - 1.0));
                    for (glm::vec3& p : light.points)
                        p.z -= 2.0f;
                    room.light({light});
                    for (const char* way : {"ltc", "ltc-clipless", "mc"})
                        EXPECT_LT(found(way), 1e-5) << i << " " << way;
                }
}

// Returns the largest ratio between a step and its larger neighbour. Where light bends smoothly, steps change slowly.
double worst_step(const std::vector<double>& light)
{
    double most = 0.0, worst = 0.0;
    for (std::size_t i = 1; i < light.size(); ++i)
        most = std::max(most, std::abs(light[i] - light[i - 1]));
    const auto step = [&](std::size_t i) { return std::abs(light[i + 1] - light[i]); };
    for (std::size_t i = 1; i + 2 < light.size(); ++i)
        worst = std::max(worst, step(i) / (std::max(step(i - 1), step(i + 1)) + 0.05 * most));
    return worst;
}

// Sweeps the azimuth over a quarter turn and a little beyond, since tables are mirrored at both ends. All pixels see one direction.
double sweep_of_eyes(const LitPlate& room, FrameDesc d, double theta)
{
    std::vector<double> light;
    for (int i = -10; i <= 190; ++i) {
        const double phi = 0.5 * (i + 0.5) / 180.0 * 3.14159265358979;
        const glm::vec3 eye(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        d.view = make_view(2.0f * eye, {0, 0, 0}, 0.002f, d.width, d.height);
        light.push_back(mean_radiance(room.seen(d)));
    }
    return worst_step(light);
}

double sweep_of_widths(const LitPlate& room, FrameDesc d)
{
    std::vector<double> light;
    d.view = make_view({0.7f, 0.5f, 1.3f}, {0, 0, 0}, 0.002f, d.width, d.height);
    for (int i = -20; i <= 20; ++i) {
        d.anisotropy = static_cast<float>(0.004 * (i + 0.5));
        light.push_back(mean_radiance(room.seen(d)));
    }
    return worst_step(light);
}

TEST(area_lights, sweeps_have_no_step_where_tables_are_mirrored)
{
    LitPlate room(1.0f);
    room.light({each_area_light()[0], each_area_light()[2]});
    FrameDesc d = desc_of_plate(kPlateEyes[0], 0.55f, 0.7f);
    d.width = d.height = 4;
    for (const char* way : {"ltc", "ltc-clipless"}) {
        d.area_way = way_named(way);
        for (const double theta : {0.4, 1.0, 1.3})
            EXPECT_LT(sweep_of_eyes(room, d, theta), 2.5) << way << " " << theta;
        EXPECT_LT(sweep_of_widths(room, d), 2.5) << way;
    }
    // A table whose symmetry is broken shows steps for eyes along the grain and where both widths are equal.
    d.area_way = way_named("ltc");
    ltc::Table broken = ltc::shipped_table();
    for (std::size_t node = 0; node < broken.grid.nodes(); ++node)
        if (const std::array<int, 4> i = broken.grid.indices(node); i[1] == 0 || i[3] == broken.grid.size - 1)
            broken.entries[ltc::kChannels * node + 5] += 0.1f; // the lobe leans sideways
    const Result<ltc::ShadingTables> tables = ltc::with_table(broken, "broken");
    ASSERT_TRUE(tables);
    room.ltc = std::make_shared<const ltc::ShadingTables>(*tables);
    EXPECT_GT(sweep_of_eyes(room, d, 1.0), 5.0);
    EXPECT_GT(sweep_of_widths(room, d), 5.0);
}

Image picture_of(int width, int height, const std::function<glm::vec3(int x, int y)>& colour)
{
    Image image = make_image(width, height, 3, PixelType::f32);
    auto* to = reinterpret_cast<glm::vec3*>(image.bytes.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            *to++ = colour(x, y);
    return image;
}

AreaLight hung_light()
{
    AreaLight light = area_light_of(AreaShape::quad, {{-1.2f, 0.9f, 0.3f}, {-1.2f, 0.9f, 1.1f}, {0.9f, 0.8f, 1.1f}, {0.9f, 0.8f, 0.3f}});
    light.two_sided = true;
    return light;
}

TEST(area_lights, a_picture_of_one_colour_is_none_word_for_word)
{
    for (const char* way : {"ltc", "ltc-clipless", "ltc-isotropic", "mc"})
        for (const float metallic : {0.0f, 1.0f}) {
            LitPlate room(metallic);
            const LightPicture picture = room.hang(picture_of(12, 5, [](int, int) { return glm::vec3(0.3f, 1.7f, 0.9f); }));
            FrameDesc d = desc_of_plate(kPlateEyes[1], 0.5f, 0.6f);
            d.area_way = way_named(way);
            AreaLight light = hung_light();
            light.texture = 0;
            room.light({light});
            const Image textured = room.seen(d);
            light.texture = kNone;
            for (int c = 0; c < 3; ++c)
                light.radiance[c] *= picture.mean[c];
            room.light({light});
            EXPECT_EQ(most_difference(textured, room.seen(d)), 0.0) << way << " metallic " << metallic;
            EXPECT_GT(mean_radiance(textured), 1e-4);
        }
}

// Returns the mean absolute difference divided by the mean.
double mean_error(const Image& found, const Image& reference)
{
    double error = 0.0, all = 0.0;
    for (std::size_t k = 0; k < reference.bytes.size() / sizeof(float); ++k) {
        error += std::abs(static_cast<double>(found.f32()[k]) - static_cast<double>(reference.f32()[k]));
        all += static_cast<double>(reference.f32()[k]);
    }
    return error / all;
}

// Two colours, side by side or one above the other, on a light that fills much of the lobe. The texture fetches carry no cosine weight.
TEST(area_lights, pictures_by_cosines_are_what_sampling_finds)
{
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.35f, 0.6f})
            for (const bool across : {false, true}) {
                LitPlate room(metallic);
                room.hang(picture_of(64, 64, [&](int x, int y) {
                    return (across ? x : y) < 32 ? glm::vec3(1.0f, 0.1f, 0.0f) : glm::vec3(0.0f, 0.2f, 1.0f);
                }));
                AreaLight light = hung_light();
                light.texture = 0;
                room.light({light});
                FrameDesc d = desc_of_plate(kPlateEyes[1], roughness, 0.7f);
                const Image cosines = room.seen(d);
                d.area_way = way_named("mc"), d.light_samples = 1024;
                const Image sampled = room.seen(d);
                light.texture = kNone;
                room.light({light});
                const Image even_sampled = room.seen(d);
                d.area_way = way_named("ltc");
                const double with = mean_error(cosines, sampled), without = mean_error(room.seen(d), even_sampled);
                std::printf("metallic %.0f roughness %.2f %s: off by %.2f %%, without a picture %.2f %%\n", static_cast<double>(metallic),
                            static_cast<double>(roughness), across ? "across" : "upright", 100.0 * with, 100.0 * without);
                EXPECT_LT(with, without + 0.12);
            }
}

TEST(area_lights, a_mirrored_node_mirrors_its_picture)
{
    LitPlate room(1.0f);
    room.hang(picture_of(8, 8, [](int x, int y) { return glm::vec3(x < 4 ? 1.0f : 0.1f, y < 4 ? 1.0f : 0.2f, x == y ? 1.0f : 0.3f); }));
    AreaLight light = hung_light();
    light.texture = 0;
    FrameDesc d = desc_of_plate({0.0f, -1.0f, 0.9f}, 0.3f, 0.5f);
    for (const char* way : {"ltc", "mc"}) {
        d.area_way = way_named(way), d.light_samples = 4096;
        room.light({light});
        const Image straight = room.seen(d);
        room.light({light}, glm::scale(glm::mat4(1.0f), {-1.0f, 1.0f, 1.0f}));
        const Image mirrored = room.seen(d);
        double most = 0.0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                for (int c = 0; c < 3; ++c)
                    most = std::max(most, std::abs(static_cast<double>(straight.f32()[3 * (16 * y + x) + c]) -
                                                   static_cast<double>(mirrored.f32()[3 * (16 * y + 15 - x) + c])));
        EXPECT_LT(most, way[0] == 'l' ? 1e-3 : 0.1) << way; // random samples
    }
}

TEST(area_lights, change_nothing_where_there_are_none_or_none_are_wanted)
{
    LitPlate room(1.0f);
    FrameDesc d = desc_of_plate(kPlateEyes[0], 0.5f, 0.7f);
    for (int way = 0; way < static_cast<int>(area_ways().size()); ++way) {
        d.area_way = way;
        EXPECT_EQ(mean_radiance(room.seen(d)), 0.0);
    }
    room.light(each_area_light());
    d.area_way = way_named("off");
    EXPECT_EQ(mean_radiance(room.seen(d)), 0.0);
}

TEST(area_lights, are_the_same_bits_on_every_instruction_set)
{
    Stage stage(plate(0.5f), 0.1f);
    for (AreaLight light : each_area_light()) {
        light.two_sided = true;
        stage.tables.area_lights.push_back(*place_area_light(light, glm::mat4(1.0f)));
    }
    for (const char* way : {"ltc", "ltc-clipless", "ltc-isotropic", "mc"}) {
        FrameDesc d = desc_of_plate(kPlateEyes[1], 0.4f, 0.7f);
        d.area_way = way_named(way), d.tilt_rad = glm::vec2(0.3f, 0.1f);
        const std::uint64_t want = pixel_hash(stage.render(d, Isa::scalar).color);
        for (const Isa isa : available_isas())
            EXPECT_EQ(pixel_hash(stage.render(d, isa).color), want) << way << " " << isa_name(isa);
    }
}

} // namespace
} // namespace burnish::test
