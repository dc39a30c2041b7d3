// Blended surfaces: the exact "over" of all layers in a pixel, for any number and order, with multisampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <iterator>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/frame.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct Sheet {
    float z; // the eye looks down from z = 1
    glm::vec4 color;
    AlphaMode mode = AlphaMode::blend;
    float slope = 0.0f; // of z along x
    glm::vec4 place{};  // left, top, right, bottom in pixels; empty: the whole image
};

constexpr int kWidth = 24;

// Builds unlit sheets in the list's order. They cover the image except for `margin` pixels on each side.
Scene sheets_of(const std::vector<Sheet>& sheets, float margin)
{
    std::vector<Triangle> triangles;
    for (const Sheet& sheet : sheets) {
        const auto corner = [&](float x, float y) { return glm::vec3(x, -y, sheet.z + sheet.slope * (x - 0.5f * kWidth)); };
        glm::vec4 at = sheet.place;
        if (at.z <= at.x)
            at = {margin, margin, kWidth - margin, kWidth - margin};
        triangles.push_back({corner(at.x, at.y), corner(at.x, at.w), corner(at.z, at.w)});
        triangles.push_back({corner(at.x, at.y), corner(at.z, at.w), corner(at.z, at.y)});
    }
    Scene s = scene_of(triangles, true);
    s.materials.clear(), s.primitives.clear();
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        Primitive p;
        p.first_index = static_cast<std::uint32_t>(6 * i), p.index_count = 6;
        p.first_vertex = static_cast<std::uint32_t>(6 * i), p.vertex_count = 6;
        p.material = static_cast<int>(i);
        s.primitives.push_back(p);
        Material m;
        m.unlit = m.double_sided = true;
        m.base_color = sheets[i].color, m.alpha_mode = sheets[i].mode;
        s.materials.push_back(m);
    }
    s.meshes[0].primitive_count = static_cast<std::uint32_t>(sheets.size());
    update_world(s);
    return s;
}

FrameDesc desc_with(int msaa)
{
    FrameDesc d;
    d.width = d.height = kWidth, d.msaa = msaa;
    d.view = pixel_view(kWidth, kWidth);
    d.background = false;
    return d;
}

Frame draw(const std::vector<Sheet>& sheets, int msaa, float margin = -4.0f)
{
    return Stage(sheets_of(sheets, margin), 0.0f).render(desc_with(msaa), best_isa());
}

glm::dvec3 middle(const Frame& f)
{
    const float* c = f.color.f32() + 3 * (kWidth / 2 * kWidth + kWidth / 2);
    return glm::dvec3(c[0], c[1], c[2]);
}

// Composites the sheets with "over" from the farthest to the nearest, in double precision.
glm::dvec3 over(std::vector<Sheet> sheets)
{
    std::sort(sheets.begin(), sheets.end(), [](const Sheet& a, const Sheet& b) { return a.z < b.z; });
    glm::dvec3 light(0.0);
    for (const Sheet& s : sheets) {
        const double alpha = s.mode == AlphaMode::blend ? static_cast<double>(s.color.a) : 1.0;
        light = glm::dvec3(s.color) * alpha + light * (1.0 - alpha);
    }
    return light;
}

constexpr glm::vec4 kRed(1, 0, 0, 0.5f), kGreen(0, 1, 0, 0.5f), kBlue(0, 0, 1, 1);

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double bound, int msaa)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(a[c], b[c], bound) << "channel " << c << ", " << msaa << " samples";
}

TEST(blend, sheets_are_composed_whatever_their_order)
{
    std::vector<Sheet> sheets = {{0.1f, kBlue, AlphaMode::opaque}, {0.2f, kGreen}, {0.3f, kRed}};
    do
        for (int msaa : {1, 2, 4, 8, 16})
            expect_near(middle(draw(sheets, msaa)), {0.5, 0.25, 0.25}, 1e-6, msaa);
    while (std::next_permutation(sheets.begin(), sheets.end(), [](const Sheet& a, const Sheet& b) { return a.z < b.z; }));
}

TEST(blend, thin_and_many_sheets_are_exact)
{
    for (int msaa : {1, 4, 16}) {
        expect_near(middle(draw({{0.2f, {1, 1, 1, 0.03f}}}, msaa)), glm::dvec3(0.03), 1e-6, msaa);
        std::vector<Sheet> twelve;
        for (int i = 0; i < 12; ++i)
            twelve.push_back({0.1f + 0.05f * static_cast<float>(i * 5 % 12), {1, 1, 1, 0.2f}});
        expect_near(middle(draw(twelve, msaa)), glm::dvec3(1.0 - std::pow(0.8, 12.0)), 1e-5, msaa);
    }
    Random random{7};
    std::vector<Sheet> many;
    for (int i = 0; i < 150; ++i)
        many.push_back(
            {0.01f + 0.006f * static_cast<float>(i * 67 % 150), {random.unit(), random.unit(), random.unit(), 0.1f * random.unit()}});
    many.push_back({0.001f, kBlue, AlphaMode::opaque});
    expect_near(middle(draw(many, 2)), over(many), 2e-5, 2);
}

// Returns the least CPU time of five frames with `count` sheets, in clock ticks. One session draws all, so nothing is prepared meanwhile.
double time_of_sheets(int count)
{
    std::vector<Sheet> sheets;
    for (int i = 0; i < count; ++i)
        sheets.push_back({0.01f + 0.9f * static_cast<float>(i * 7 % count) / static_cast<float>(count), {1, 1, 1, 0.001f}});
    const Stage stage(sheets_of(sheets, -4.0f), 0.0f);
    Result<Session> session = Session::make(stage.parts(), {});
    double least = 1e30;
    EXPECT_TRUE(session);
    for (int k = 0; k < 5; ++k) {
        const std::clock_t begin = std::clock();
        const Result<Frame> frame = session->render(desc_with(1));
        least = std::min(least, static_cast<double>(std::clock() - begin));
        expect_near(middle(*frame), glm::dvec3(1.0 - std::pow(0.999, count)), 1e-4, 1);
    }
    return least;
}

TEST(blend, time_grows_as_the_number_of_sheets)
{
    const double few = time_of_sheets(500), many = time_of_sheets(2000);
    EXPECT_LT(many, 8.0 * few); // 4 by the number; 16 if each layer looks at all sheets
}

TEST(blend, what_is_solid_hides_what_lies_behind_it)
{
    for (int msaa : {1, 8}) {
        expect_near(middle(draw({{0.3f, kRed}, {0.4f, kBlue, AlphaMode::opaque}}, msaa)), {0, 0, 1}, 0.0, msaa);
        expect_near(middle(draw({{0.2f, kRed}, {0.3f, kBlue, AlphaMode::opaque}, {0.4f, kGreen}}, msaa)), {0, 0.5, 0.5}, 1e-6, msaa);
        expect_near(middle(draw({{0.3f, {1, 1, 1, 1}, AlphaMode::mask}, {0.4f, kRed}, {0.2f, kGreen}}, msaa)), {1, 0.5, 0.5}, 1e-6, msaa);
        // a sheet on a solid one, at the same depth
        expect_near(middle(draw({{0.3f, kBlue, AlphaMode::opaque}, {0.3f, kRed}}, msaa)), {0.5, 0, 0.5}, 1e-6, msaa);
        // at equal depths the sheet that is drawn first lies in front
        expect_near(middle(draw({{0.3f, kRed}, {0.3f, kGreen}}, msaa)), {0.5, 0.25, 0}, 1e-6, msaa);
    }
}

TEST(blend, sheets_that_cross_are_sorted_by_sample)
{
    const std::vector<Sheet> crossing = {{0.5f, kRed, AlphaMode::blend, 0.01f}, {0.5f, kGreen, AlphaMode::blend, -0.01f}};
    const Frame f = draw(crossing, 4);
    const float* left = f.color.f32() + 3 * (12 * kWidth + 4);
    const float* right = f.color.f32() + 3 * (12 * kWidth + 20);
    EXPECT_NEAR(left[1], 0.5f, 1e-6f);
    EXPECT_NEAR(left[0], 0.25f, 1e-6f);
    EXPECT_NEAR(right[0], 0.5f, 1e-6f);
    EXPECT_NEAR(right[1], 0.25f, 1e-6f);
}

TEST(blend, edges_cover_their_share_of_samples)
{
    const Frame f = draw({{0.3f, {1, 1, 1, 0.25f}}}, 16, 4.5f); // edges through the middle of pixels
    const float* row = f.color.f32() + 3 * (12 * kWidth);
    EXPECT_EQ(row[3 * 3], 0.0f);
    EXPECT_NEAR(row[3 * 4], 0.125f, 1e-6f);
    EXPECT_NEAR(row[3 * 5], 0.25f, 1e-6f);
}

TEST(blend, both_sides_of_a_closed_mesh_are_seen)
{
    Scene box = sheets_of({{0.2f, {1, 1, 1, 0.5f}}, {0.6f, {1, 1, 1, 0.5f}}}, 2.0f);
    EXPECT_NEAR(middle(Stage(box, 0.0f).render(desc_with(4), best_isa()))[0], 0.75, 1e-6);
    box.materials[0].double_sided = false; // facing away or towards the eye: the first is drawn only if its front is visible
    std::swap(box.indices[1], box.indices[2]), std::swap(box.indices[4], box.indices[5]);
    EXPECT_NEAR(middle(Stage(box, 0.0f).render(desc_with(4), best_isa()))[0], 0.5, 1e-6);
}

TEST(blend, an_alpha_of_one_is_opaque_to_the_bit)
{
    std::vector<Sheet> sheets = {{0.2f, {0.3f, 0.7f, 0.1f, 1}}, {0.5f, {0.9f, 0.2f, 0.4f, 1}, AlphaMode::blend, 0.02f}};
    const std::uint64_t blended = pixel_hash(draw(sheets, 4, 3.3f).color);
    for (Sheet& s : sheets)
        s.mode = AlphaMode::opaque;
    EXPECT_EQ(blended, pixel_hash(draw(sheets, 4, 3.3f).color));
}

TEST(blend, alpha_and_parts_of_pixels_hold_what_shows_through)
{
    FrameDesc d = desc_with(4);
    d.triangle_ids = d.parts = true;
    const Frame f = Stage(sheets_of({{0.2f, {1, 1, 1, 0.2f}}, {0.4f, {1, 1, 1, 0.5f}}}, 4.4f), 0.0f).render(d, best_isa());
    const Image rgba = with_coverage(f.color, f.triangle_ids, f.through);
    for (int i = 0; i < kWidth * kWidth; ++i) // white over black: light equals coverage
        EXPECT_NEAR(rgba.f32()[4 * i + 3], rgba.f32()[4 * i], 1e-6f);
    EXPECT_NEAR(rgba.f32()[4 * (12 * kWidth + 12) + 3], 0.6f, 1e-6f);
    std::vector<float> sums(std::size_t{kWidth} * kWidth, -1.0f);
    for (const PixelPart& part : f.parts)
        sums[part.pixel] = std::max(sums[part.pixel], 0.0f) + part.color[0] * static_cast<float>(part.samples) / 4.0f;
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] >= 0.0f) {
            EXPECT_NEAR(sums[i], f.color.f32()[3 * i], 1e-6f);
        }
    EXPECT_GT(std::count_if(sums.begin(), sums.end(), [](float s) { return s >= 0.0f; }), 200);
}

TEST(blend, layers_show_a_surface_whose_alpha_is_above_a_half)
{
    FrameDesc d = desc_with(1);
    d.layers = true;
    const auto depth = [&](float alpha) {
        const Frame f = Stage(sheets_of({{0.2f, kBlue, AlphaMode::opaque}, {0.6f, {1, 1, 1, alpha}}}, 1.0f), 0.0f).render(d, best_isa());
        return f.layers.data()[12 * kWidth + 12].depth;
    };
    EXPECT_NEAR(depth(0.4f), 0.8f, 1e-5f);
    EXPECT_NEAR(depth(0.6f), 0.4f, 1e-5f);
}

// A lit scene where every second material blends.
Scene veiled_spheres()
{
    Scene scene = *make_builtin_scene("spheres");
    for (std::size_t i = 0; i < scene.materials.size(); i += 2)
        scene.materials[i].alpha_mode = AlphaMode::blend, scene.materials[i].base_color.a = 0.4f, scene.materials[i].double_sided = true;
    return scene;
}

TEST(blend, words_are_the_same_for_every_isa_thread_count_and_tile_size)
{
    for (int msaa : {1, 4}) {
        std::uint64_t hash = 0;
        for (int threads : {1, 3}) {
            const Stage stage(veiled_spheres(), 1.0f, threads);
            for (int tile : {32, 64})
                for (Isa isa : available_isas()) {
                    FrameDesc d;
                    d.width = 83, d.height = 61, d.msaa = msaa, d.tile_size = tile;
                    d.view = auto_frame(stage.tables, d.width, d.height);
                    const std::uint64_t here = pixel_hash(stage.render(d, isa).color);
                    hash = hash ? hash : here;
                    EXPECT_EQ(here, hash) << isa_name(isa) << ", " << threads << " threads, tiles of " << tile << ", " << msaa
                                          << " samples";
                }
        }
    }
}

// Small and large sheets, blended and opaque, in any order, against the sum over all sheets at each pixel's centre.
TEST(blend, sheets_of_all_sizes_hide_and_show_each_other)
{
    Random random{11};
    for (int picture = 0; picture < 60; ++picture) {
        std::vector<Sheet> sheets;
        for (int i = 0; i < 40; ++i) {
            const auto place = [&](float low, float high) { return std::floor(low + (high - low) * random.unit()) + 0.25f; };
            const float x = place(-2.0f, 20.0f), y = place(-2.0f, 20.0f), largest = i % 3 ? 7.0f : 22.0f;
            sheets.push_back({0.05f + 0.02f * static_cast<float>(i * 23 % 40),
                              {random.unit(), random.unit(), random.unit(), random.unit()},
                              i % 4 ? AlphaMode::blend : AlphaMode::opaque,
                              0.0f,
                              {x, y, x + place(1.0f, largest), y + place(1.0f, largest)}});
        }
        const Frame f = draw(sheets, 1);
        for (int y = 0; y < kWidth; ++y)
            for (int x = 0; x < kWidth; ++x) {
                std::vector<Sheet> here;
                const float cx = static_cast<float>(x) + 0.5f, cy = static_cast<float>(y) + 0.5f;
                std::copy_if(sheets.begin(), sheets.end(), std::back_inserter(here),
                             [&](const Sheet& s) { return cx > s.place.x && cx < s.place.z && cy > s.place.y && cy < s.place.w; });
                const glm::dvec3 right = over(here);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(f.color.f32()[3 * (y * kWidth + x) + c], right[c], 1e-5)
                        << "picture " << picture << ", pixel " << x << "," << y << ", channel " << c;
            }
    }
}

// Pixels without a blended surface keep the bits of the scene without it, edges included.
TEST(blend, pixels_beside_a_sheet_keep_their_bits)
{
    const std::vector<Sheet> solid = {{0.2f, {0.3f, 0.7f, 0.1f, 1}, AlphaMode::opaque, 0.01f},
                                      {0.2f, {0.9f, 0.2f, 0.4f, 1}, AlphaMode::opaque, -0.01f}};
    std::vector<Sheet> both = solid;
    both.push_back({0.9f, {1, 1, 1, 0.5f}});
    Scene scene = sheets_of(both, 1.3f);
    for (std::size_t i = 12; i < 18; ++i) // moves the sheet's corners to the left half
        scene.vertices.px[i] *= 0.4f;
    const Frame with = Stage(scene, 0.0f).render(desc_with(8), best_isa()), without = draw(solid, 8, 1.3f);
    std::size_t same = 0, other = 0;
    for (std::size_t i = 0; i < std::size_t{kWidth} * kWidth; ++i)
        ++(std::memcmp(with.color.f32() + 3 * i, without.color.f32() + 3 * i, 12) == 0 ? same : other);
    EXPECT_GT(same, 280u);
    EXPECT_GT(other, 150u);
}

} // namespace
} // namespace burnish::test
