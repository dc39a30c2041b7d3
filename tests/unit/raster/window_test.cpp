// Windows of larger pictures have the pixels of the whole picture.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/exact_projection.h"
#include "raster/frame/frame_record.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

struct WindowCase {
    const char* scene; // empty: the inside of a box, whose walls cross the near plane and leave the guard band
    const char* technique;
    int width, height, msaa;
    float tan_half;
};
constexpr WindowCase kWindowCases[] = {{"spheres", "mc", 317, 203, 4, 0.0f},
                                       {"teapot", "lobe_line", 200, 151, 8, 0.0f},
                                       {"bumps", "bent_normal", 160, 121, 1, 0.0f},
                                       {"", "split_isotropic", 201, 133, 4, 1.0f},
                                       {"", "split_isotropic", 203, 131, 1, 40.0f}};

Stage stage_for(const WindowCase& c)
{
    if (*c.scene)
        return Stage(std::move(*make_builtin_scene(c.scene)), 1.0f, 2);
    return Stage(scene_of(tessellated_box(1.0f, 2), true), 1.0f, 2);
}

FrameDesc desc_for(const WindowCase& c, const Stage& stage)
{
    FrameDesc d;
    d.width = c.width, d.height = c.height, d.msaa = c.msaa, d.technique = c.technique,
    d.samples = find_technique(c.technique)->default_samples;
    d.view = auto_frame(stage.tables, c.width, c.height);
    if (!*c.scene) {
        d.view = make_view(glm::vec3(0.3f, -0.2f, 0.9f), glm::vec3(-0.4f, 0.5f, -1.0f), 1.2f, c.width, c.height);
        d.view.tan_half_x *= c.tan_half, d.view.tan_half_y *= c.tan_half;
    }
    return d;
}

// Counts the pixels of a window that differ from the whole picture's, at least `rim` pixels from the window's sides within the picture.
int differing(const Image& window, const PictureWindow& at, const Image& whole, int rim)
{
    int count = 0;
    for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x) {
            const int px = at.left + x, py = at.top + y;
            const bool near_left = x < rim && at.left > 0, near_right = x >= window.width - rim && at.left + window.width < whole.width;
            const bool near_top = y < rim && at.top > 0, near_bottom = y >= window.height - rim && at.top + window.height < whole.height;
            if (near_left || near_right || near_top || near_bottom)
                continue;
            count +=
                std::memcmp(window.f32() + 3 * (y * window.width + x), whole.f32() + 3 * (py * whole.width + px), 3 * sizeof(float)) != 0;
        }
    return count;
}

TEST(window, has_the_pixels_of_the_whole_picture)
{
    for (const WindowCase& c : kWindowCases) {
        const Stage stage = stage_for(c);
        const FrameDesc whole = desc_for(c, stage);
        const int rim = find_technique(c.technique)->traits & kSharesSamples ? kWindowStep : 0;
        const Image picture = stage.render(whole, best_isa()).color;
        const int places[][4] = {{0, 0, 64, 16}, {0, 64, c.width, 48}, {72, 40, 80, 72}, {8, 8, c.width - 8, c.height - 8}};
        for (const auto& place : places)
            for (const int tile : {32, 64})
                for (const Isa isa : available_isas()) {
                    FrameDesc d = whole;
                    d.tile_size = tile, d.width = place[2], d.height = place[3];
                    d.window = {c.width, c.height, place[0], place[1]};
                    ASSERT_TRUE(check_desc(d));
                    EXPECT_EQ(differing(stage.render(d, isa).color, d.window, picture, rim), 0)
                        << c.scene << " " << c.technique << " " << isa_name(isa) << " tile " << tile << " from " << place[0] << ", "
                        << place[1];
                }
    }
}

// Returns a point's place, [0,1] across and down the picture; outside where it lies behind the eye.
glm::dvec2 screen_place(const View& v, const glm::dvec3& point)
{
    const glm::dvec3 d = point - glm::dvec3(v.eye);
    const double depth = glm::dot(glm::dvec3(v.forward), d);
    if (depth <= 0.0)
        return {-1.0, -1.0};
    return {0.5 + 0.5 * glm::dot(glm::dvec3(v.right), d) / (depth * static_cast<double>(v.tan_half_x)),
            0.5 - 0.5 * glm::dot(glm::dvec3(v.up), d) / (depth * static_cast<double>(v.tan_half_y))};
}

TEST(window, of_a_picture_with_cells_shows_the_exact_projection)
{
    constexpr int kWide = kMaxWindowedSide, kHigh = 40000;
    const Triangle corners = {glm::vec3(-1.3f, -0.9f, -2.0f), glm::vec3(1.7f, -0.2f, -2.5f), glm::vec3(-0.1f, 1.1f, -1.5f)};
    for (const float scale : {1.0f, 30.0f}) { // the larger one is cut at every cell's guard band
        const Triangle scaled = {scale * corners[0], scale * corners[1], scale * corners[2]};
        const Stage stage(scene_of({scaled}, true));
        FrameDesc d;
        d.msaa = 1, d.background = false, d.triangle_ids = true, d.technique = "split_isotropic";
        d.view = make_view(glm::vec3(0.1f, 0.2f, 1.0f), glm::vec3(0.0f, 0.0f, -1.0f), 0.9f, kWide, kHigh);
        d.width = d.height = 64;
        const glm::vec3 places[3] = {scaled[0], scaled[1], scaled[2]};
        const ProjectedTriangle exact = project(view_record(d.view), kWide, kHigh, places);
        Random random{9};
        int covered = 0, near_edges = 0, wrong = 0;
        for (int n = 0; n < 400; ++n) {
            // Place the window by chance, or at a place of an edge
            glm::dvec2 at(random.unit(), random.unit());
            if (n % 2) {
                const auto i = static_cast<std::size_t>(n % 3);
                at = screen_place(d.view,
                                  glm::mix(glm::dvec3(scaled[i]), glm::dvec3(scaled[(i + 1) % 3]), static_cast<double>(random.unit())));
            }
            if (!(at.x > 0.0 && at.x < 1.0 && at.y > 0.0 && at.y < 1.0))
                continue;
            const int left = static_cast<int>(at.x * (kWide - 64)) / 8 * 8, top = static_cast<int>(at.y * (kHigh - 64)) / 8 * 8;
            if (left / kWindowCell != (left + 63) / kWindowCell || top / kWindowCell != (top + 63) / kWindowCell)
                continue;
            d.window = {kWide, kHigh, left, top};
            ASSERT_TRUE(check_desc(d));
            const Frame frame = stage.render(d, best_isa());
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) {
                    const bool shown = frame.triangle_ids[static_cast<std::size_t>(64 * y + x)] != kNoTriangle;
                    const Long inside = exact.inside(Long(left + x) + 0.5L, Long(top + y) + 0.5L);
                    covered += shown, near_edges += std::fabs(inside) < 1;
                    wrong += shown != (inside >= 0) &&
                             std::fabs(inside) > 0.02L; // positions lie on a grid of 1/256 pixel, of floats with 24 bits
                }
        }
        EXPECT_EQ(wrong, 0) << scale;
        EXPECT_GT(covered, 1000) << scale;
        EXPECT_GT(near_edges, 30) << scale;
    }
}

TEST(window, agrees_with_its_neighbour_in_the_next_cell)
{
    const Stage stage(std::move(*make_builtin_scene("teapot")), 1.0f, 2);
    FrameDesc d;
    d.msaa = 4, d.technique = "bent_normal", d.width = 64, d.height = 64;
    constexpr int kWide = 40000, kHigh = 30000;
    d.view = auto_frame(stage.tables, kWide, kHigh);
    int shown = 0;
    double worst = 0.0;
    for (int top = 8; top < kHigh - 64; top += 1496) {
        if (top / kWindowCell != (top + 63) / kWindowCell)
            continue;
        d.window = {kWide, kHigh, kWindowCell - 56, top};
        const Frame before = stage.render(d, best_isa());
        d.window.left = kWindowCell - kWindowStep;
        const Frame after = stage.render(d, best_isa());
        shown += static_cast<int>(before.stats.visible_fragments > 0);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 2 * kWindowStep; ++x)
                for (int c = 0; c < 3; ++c)
                    worst = std::fmax(worst, std::fabs(static_cast<double>(before.color.f32()[3 * (64 * y + 48 + x) + c]) -
                                                       static_cast<double>(after.color.f32()[3 * (64 * y + x) + c])));
    }
    EXPECT_GT(shown, 5);
    EXPECT_LE(worst, 1e-5);
}

TEST(window, is_refused_where_it_lies_outside_or_across_cells)
{
    FrameDesc d;
    d.width = d.height = 64;
    const auto refused = [&](const PictureWindow& window) {
        d.window = window;
        const Status status = check_desc(d);
        return !status && status.error().field == "FrameDesc::window";
    };
    EXPECT_FALSE(refused({64, 64, 0, 0}));
    EXPECT_FALSE(refused({0, 0, 0, 0}));
    EXPECT_FALSE(refused({kMaxWindowedSide, kMaxWindowedSide, kWindowCell - 8, 2 * kWindowCell - 56}));
    for (const PictureWindow& window : {PictureWindow{63, 64, 0, 0},
                                        {64, 0, 0, 0},
                                        {0, 64, 0, 0},
                                        {0, 0, 8, 0},
                                        {100, 100, 4, 0},
                                        {100, 100, 0, 40},
                                        {100, 100, -8, 0},
                                        {kMaxWindowedSide + 1, 64, 0, 0},
                                        {40000, 64, kWindowCell - 24, 0}})
        EXPECT_TRUE(refused(window)) << window.picture_width << " " << window.left << " " << window.top;
}

} // namespace
} // namespace burnish::test
