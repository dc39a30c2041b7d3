// Samples that a triangle covers: Vulkan's sample positions, watertight edges, near-plane clipping, depth order.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/builtin/builtin.h"
#include "raster/frame/upload.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr std::uint32_t kNothing = 0xffffffffu;
constexpr int kCounts[] = {1, 2, 4, 8, 16};

struct Lattice { // 1/256 pixel
    int x, y;
};
using LatticeTriangle = std::array<Lattice, 3>;

std::int64_t cross(const Lattice& a, const Lattice& b, const Lattice& c)
{
    return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

// Partitions the rectangle from -margin to side + margin into a jittered grid of quads with random diagonals. Then splits random triangles
// at inner lattice points until there are `count`. Triangles share corners exactly.
std::vector<LatticeTriangle> random_partition(int width, int height, int cells, std::size_t count, Random& random)
{
    const int margin = 300;
    std::vector<std::vector<Lattice>> grid(static_cast<std::size_t>(cells) + 1);
    const int step_x = (width * 256 + 2 * margin) / cells, step_y = (height * 256 + 2 * margin) / cells;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            Lattice p = {i * step_x - margin, j * step_y - margin};
            if (i > 0 && i < cells)
                p.x += random.below(step_x / 2) - step_x / 4;
            if (j > 0 && j < cells)
                p.y += random.below(step_y / 2) - step_y / 4;
            if (i == cells)
                p.x = width * 256 + margin;
            if (j == cells)
                p.y = height * 256 + margin;
            grid[static_cast<std::size_t>(j)].push_back(p);
        }
    std::vector<LatticeTriangle> triangles;
    for (std::size_t j = 0; j + 1 < grid.size(); ++j)
        for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
            const Lattice a = grid[j][i], b = grid[j][i + 1], c = grid[j + 1][i + 1], d = grid[j + 1][i];
            if (random.below(2)) {
                triangles.push_back({a, b, c});
                triangles.push_back({a, c, d});
            } else {
                triangles.push_back({a, b, d});
                triangles.push_back({b, c, d});
            }
        }
    while (triangles.size() < count) {
        const std::size_t at = random.next() % triangles.size();
        const LatticeTriangle t = triangles[at];
        const int u = 1 + random.below(254), v = 1 + random.below(255 - u);
        const Lattice p = {t[0].x + ((t[1].x - t[0].x) * u + (t[2].x - t[0].x) * v) / 256,
                           t[0].y + ((t[1].y - t[0].y) * u + (t[2].y - t[0].y) * v) / 256};
        if (cross(t[0], t[1], p) <= 0 || cross(t[1], t[2], p) <= 0 || cross(t[2], t[0], p) <= 0)
            continue;
        triangles[at] = {t[0], t[1], p};
        triangles.push_back({t[1], t[2], p});
        triangles.push_back({t[2], t[0], p});
    }
    return triangles;
}

Triangle to_world(const LatticeTriangle& t, float z)
{
    Triangle w;
    for (std::size_t i = 0; i < 3; ++i)
        w[i] = {static_cast<float>(t[i].x) / 256.0f, -static_cast<float>(t[i].y) / 256.0f, z};
    return w;
}

bool same(const Column<std::uint32_t>& a, const Column<std::uint32_t>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

FrameDesc id_desc(int width, int height, int msaa)
{
    FrameDesc d;
    d.width = width, d.height = height, d.msaa = msaa;
    d.view = pixel_view(width, height);
    d.triangle_ids = true;
    return d;
}

TEST(coverage, sample_positions_equal_the_vulkan_table)
{
    // Vulkan 1.3, "Standard sample locations", as printed there: x, y in pixels
    const std::vector<std::vector<glm::vec2>> table = {{{0.5f, 0.5f}},
                                                       {{0.75f, 0.75f}, {0.25f, 0.25f}},
                                                       {{0.375f, 0.125f}, {0.875f, 0.375f}, {0.125f, 0.625f}, {0.625f, 0.875f}},
                                                       {{0.5625f, 0.3125f},
                                                        {0.4375f, 0.6875f},
                                                        {0.8125f, 0.5625f},
                                                        {0.3125f, 0.1875f},
                                                        {0.1875f, 0.8125f},
                                                        {0.0625f, 0.4375f},
                                                        {0.6875f, 0.9375f},
                                                        {0.9375f, 0.0625f}},
                                                       {{0.5625f, 0.5625f},
                                                        {0.4375f, 0.3125f},
                                                        {0.3125f, 0.625f},
                                                        {0.75f, 0.4375f},
                                                        {0.1875f, 0.375f},
                                                        {0.625f, 0.8125f},
                                                        {0.8125f, 0.6875f},
                                                        {0.6875f, 0.1875f},
                                                        {0.375f, 0.875f},
                                                        {0.5f, 0.0625f},
                                                        {0.25f, 0.125f},
                                                        {0.125f, 0.75f},
                                                        {0.0f, 0.5f},
                                                        {0.9375f, 0.25f},
                                                        {0.875f, 0.9375f},
                                                        {0.0625f, 0.0f}}};
    for (std::size_t k = 0; k < 5; ++k) {
        const SamplePattern p = standard_samples(kCounts[k]);
        ASSERT_EQ(p.count, kCounts[k]);
        for (std::size_t i = 0; i < table[k].size(); ++i) {
            EXPECT_EQ(static_cast<float>(p.x[i]) / 256.0f, table[k][i].x) << kCounts[k] << " samples, sample " << i;
            EXPECT_EQ(static_cast<float>(p.y[i]) / 256.0f, table[k][i].y) << kCounts[k] << " samples, sample " << i;
        }
    }
}

// At equal depth the triangle drawn first stays. If drawing in reverse order gives the same owner everywhere, no sample is covered twice.
// If no sample is empty either, each is covered exactly once.
TEST(coverage, random_partition_of_100000_triangles_covers_every_sample_exactly_once)
{
    Random random{7};
    const int width = 333, height = 217;
    const std::vector<LatticeTriangle> cells = random_partition(width, height, 120, 100000, random);
    ASSERT_GE(cells.size(), 100000u);
    std::vector<Triangle> forward;
    for (const LatticeTriangle& t : cells)
        forward.push_back(to_world({t[0], t[2], t[1]}, 0.0f)); // counter-clockwise with y up
    std::vector<Triangle> backward(forward.rbegin(), forward.rend());
    const Stage a(scene_of(forward, false)), b(scene_of(backward, false));
    const std::uint32_t last = static_cast<std::uint32_t>(forward.size()) - 1;
    for (Isa isa : available_isas())
        for (int msaa : kCounts) {
            const Frame fa = a.render(id_desc(width, height, msaa), isa), fb = b.render(id_desc(width, height, msaa), isa);
            std::size_t empty = 0, twice = 0;
            for (std::size_t i = 0; i < fa.triangle_ids.size(); ++i) {
                empty += fa.triangle_ids[i] == kNothing;
                twice += fa.triangle_ids[i] != kNothing && fa.triangle_ids[i] != last - fb.triangle_ids[i];
            }
            EXPECT_EQ(empty, 0u) << isa_name(isa) << " msaa " << msaa;
            EXPECT_EQ(twice, 0u) << isa_name(isa) << " msaa " << msaa;
        }
}

// Random triangles that take the given sizes in turn (1/256 pixel), each at one of `levels` depths.
struct FlatTriangles {
    std::vector<LatticeTriangle> lattice;
    std::vector<Triangle> world;
    std::vector<float> depth;
};

FlatTriangles flat_triangles(int width, int height, int count, const std::vector<int>& sizes, int levels, Random& random)
{
    FlatTriangles out;
    for (int i = 0; i < count; ++i) {
        const int size = sizes[static_cast<std::size_t>(i) % sizes.size()];
        LatticeTriangle t;
        const Lattice c = {random.below(width * 256), random.below(height * 256)};
        for (Lattice& p : t)
            p = {c.x + random.below(size) - size / 2, c.y + random.below(size) - size / 2};
        if (i % 7 == 0) // corners on sample positions and shared rows: exercises the tie rules
            for (Lattice& p : t)
                p = {p.x & ~127, p.y & ~127};
        if (cross(t[0], t[1], t[2]) < 0)
            std::swap(t[1], t[2]);
        out.lattice.push_back(t);
        out.depth.push_back(static_cast<float>(random.below(levels)) * 0.01f);
        out.world.push_back(to_world({t[0], t[2], t[1]}, out.depth.back()));
    }
    return out;
}

// Checks every sample against a brute-force model of the rules, with overlaps and depth order. At equal depths the first triangle wins.
void expect_model(int width, int height, int msaa, const FlatTriangles& triangles)
{
    const auto& [lattice, world, depth] = triangles;
    const Stage stage(scene_of(world, false));
    const SamplePattern p = standard_samples(msaa);
    std::vector<std::uint32_t> expected(static_cast<std::size_t>(width * height * msaa), kNothing);
    for (std::size_t at = 0; at < expected.size(); ++at) {
        const int s = static_cast<int>(at) % msaa, pixel = static_cast<int>(at) / msaa;
        const Lattice q = {pixel % width * 256 + p.x[s], pixel / width * 256 + p.y[s]};
        float best = -1.0f;
        for (std::size_t i = 0; i < lattice.size(); ++i) {
            if (depth[i] <= best || cross(lattice[i][0], lattice[i][1], lattice[i][2]) <= 0)
                continue;
            bool inside = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const Lattice &a = lattice[i][k], &b = lattice[i][(k + 1) % 3];
                const std::int64_t e = cross(a, b, q);
                const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
                inside = inside && (e > 0 || (e == 0 && top_left));
            }
            if (inside) {
                best = depth[i];
                expected[at] = static_cast<std::uint32_t>(i);
            }
        }
    }
    for (Isa isa : available_isas())
        for (int tile : {32, 64}) {
            FrameDesc d = id_desc(width, height, msaa);
            d.tile_size = tile;
            const Frame f = stage.render(d, isa);
            std::size_t differ = 0;
            for (std::size_t i = 0; i < expected.size(); ++i)
                differ += f.triangle_ids[i] != expected[i];
            EXPECT_EQ(differ, 0u) << isa_name(isa) << " msaa " << msaa << " tile " << tile;
        }
}

TEST(coverage, random_triangles_equal_a_brute_force_model_sample_by_sample)
{
    Random random{11};
    const FlatTriangles triangles = flat_triangles(150, 90, 400, {60000, 6000, 700, 200}, 50, random);
    for (int msaa : kCounts)
        expect_model(150, 90, msaa, triangles);
}

// Lanes draw the small triangles together, before the large ones. There are more large ones than a tile sorts.
TEST(coverage, crowds_of_small_and_large_triangles_equal_a_brute_force_model)
{
    Random random{12};
    for (const std::vector<int>& sizes : {std::vector<int>{900, 700, 1900, 3000, 1200}, {900}, {3000, 2500, 2500}})
        expect_model(60, 50, 4, flat_triangles(60, 50, 2000, sizes, 3, random));
}

// Where several threads draw, a tile with this many triangles is split.
TEST(coverage, a_crowded_tile_is_the_same_by_one_thread_and_by_several)
{
    Random random{77};
    std::vector<Triangle> triangles;
    for (int i = 0; i < 40000; ++i) {
        const float size = i % 500 ? 3.0f : 60.0f, depth = i % 50 ? 0.1f : 2.0f; // some cross the near plane
        const glm::vec3 c(random.unit() * 90, -random.unit() * 50, random.unit() * 1.2f - 0.1f);
        const auto corner = [&] {
            return c + glm::vec3((random.unit() - 0.5f) * size, (random.unit() - 0.5f) * size, (random.unit() - 0.5f) * depth);
        };
        triangles.push_back({corner(), corner(), corner()});
    }
    const Stage one(scene_of(triangles, true)), three(scene_of(triangles, true), 1.0f, 3);
    for (int tile : {32, 64})
        for (int msaa : {1, 4})
            for (Isa isa : available_isas()) {
                FrameDesc d = id_desc(90, 50, msaa);
                d.view.znear = 0.1f, d.tile_size = tile, d.stages = true;
                const Frame a = one.render(d, isa), b = three.render(d, isa);
                EXPECT_TRUE(same(a.triangle_ids, b.triangle_ids)) << isa_name(isa) << " tile " << tile;
                EXPECT_TRUE(same(a.stages.depths, b.stages.depths)) << isa_name(isa) << " tile " << tile;
                EXPECT_EQ(pixel_hash(a.color), pixel_hash(b.color)) << isa_name(isa) << " tile " << tile;
            }
}

// Lanes and blocks draw the same samples at the same depths. The triangles are sloped, a few pixels in size, crossing, listed twice, and
// some are cut by the near plane. Alpha-tested materials go by blocks, others by lanes.
TEST(coverage, small_triangles_by_lanes_equal_those_by_blocks_bit_for_bit)
{
    Random random{31};
    std::vector<Triangle> triangles;
    for (int i = 0; i < 1500; ++i) {
        const glm::vec3 c(random.unit() * 70, -random.unit() * 50, random.unit() * 1.2f - 0.1f);
        const auto corner = [&] { return c + glm::vec3(random.unit() * 7 - 3.5f, random.unit() * 7 - 3.5f, random.unit() * 0.4f - 0.2f); };
        triangles.push_back({corner(), corner(), corner()});
        if (i % 3 == 0)
            triangles.push_back(triangles.back());
    }
    const auto draw = [&](AlphaMode alpha, int msaa, int tile, Isa isa) {
        Scene scene = scene_of(triangles, true);
        for (Material& m : scene.materials)
            m.alpha_mode = alpha, m.alpha_cutoff = 0.0f;
        FrameDesc d = id_desc(70, 50, msaa);
        d.view.znear = 0.1f, d.tile_size = tile, d.stages = true;
        return Stage(std::move(scene)).render(d, isa);
    };
    for (int msaa : {1, 4, 16}) {
        const Frame blocks = draw(AlphaMode::mask, msaa, 64, Isa::scalar);
        for (int tile : {32, 64})
            for (Isa isa : available_isas()) {
                const Frame lanes = draw(AlphaMode::opaque, msaa, tile, isa);
                EXPECT_TRUE(same(lanes.triangle_ids, blocks.triangle_ids)) << isa_name(isa) << " msaa " << msaa << " tile " << tile;
                EXPECT_TRUE(same(lanes.stages.depths, blocks.stages.depths)) << isa_name(isa) << " msaa " << msaa << " tile " << tile;
            }
    }
}

// From inside a closed box every sample sees a wall, wherever the walls cross the near plane and the guard band.
TEST(coverage, clipping_at_the_near_plane_and_guard_band_leaves_no_crack)
{
    Random random{3};
    for (int cells : {1, 5}) {
        const Stage stage(scene_of(tessellated_box(10.0f, cells), true));
        for (int k = 0; k < 24; ++k) {
            // near a wall or corner, so that walls pass beside and behind the eye
            glm::vec3 eye(random.unit() * 19.98f - 9.99f, random.unit() * 19.98f - 9.99f, random.unit() * 19.98f - 9.99f);
            if (k % 2)
                eye[k % 3] = k % 4 == 1 ? 9.99f : -9.99f;
            const glm::vec3 target(random.unit() * 20 - 10, random.unit() * 20 - 10, random.unit() * 20 - 10);
            FrameDesc d = id_desc(97, 61, 4);
            d.view = make_view(eye, target, k % 3 == 0 ? 2.6f : 1.0f, d.width, d.height);
            d.view.znear = 0.001f;
            for (Isa isa : available_isas()) {
                const Frame f = stage.render(d, isa);
                EXPECT_EQ(std::count(f.triangle_ids.begin(), f.triangle_ids.end(), kNothing), 0)
                    << isa_name(isa) << " cells " << cells << " view " << k;
            }
        }
    }
}

// A vertex between the limit of whole triangles and the clip planes: both triangles of the edge must treat it alike.
TEST(coverage, edges_into_the_guard_band_have_no_crack)
{
    for (float far_x : {-14800.0f, -15140.0f, -15400.0f, -15700.0f, -15870.0f, -15900.0f, -16300.0f, -17000.0f}) {
        std::size_t open = 0;
        for (int k = 0; k < 12; ++k) {
            const glm::vec3 a(far_x, -60.0f - 7.3f * static_cast<float>(k), 0), b(13000.0f, -130.0f, 0);
            const Stage stage(scene_of({{a, b, glm::vec3(128, 15000.0f, 0)}, {a, glm::vec3(128, -40000.0f, 0), b}}, true));
            const Frame f = stage.render(id_desc(256, 256, 16), best_isa());
            open += static_cast<std::size_t>(std::count(f.triangle_ids.begin(), f.triangle_ids.end(), kNothing));
        }
        EXPECT_EQ(open, 0u) << far_x;
    }
}

TEST(coverage, an_orthographic_view_starts_at_its_near_plane)
{
    const auto hits = [](float z) {
        const Stage stage(scene_of({{glm::vec3(-50, 50, z), glm::vec3(10, -60, z), glm::vec3(60, 50, z)}}, true));
        FrameDesc d = id_desc(20, 20, 1);
        d.view.znear = 0.25f; // the eye is at z = 1
        const Frame f = stage.render(d, best_isa());
        return std::count_if(f.triangle_ids.begin(), f.triangle_ids.end(), [](std::uint32_t id) { return id != kNothing; });
    };
    EXPECT_GT(hits(0.7f), 0);
    EXPECT_EQ(hits(0.8f), 0);  // between eye and plane
    EXPECT_EQ(hits(5.0f), 0);  // behind the eye
    EXPECT_EQ(hits(-1.5f), 0); // beyond the far plane
}

// A flat quad, then a sloped quad that has equal depth in column 40, the first of its block, and is nearer on its right. A tile that draws
// the nearest first draws the slope first.
TEST(coverage, of_equal_depths_the_first_in_the_list_is_seen)
{
    constexpr int kColumn = 40;
    const auto quad = [](float slope) {
        const auto corner = [&](float x, float y) { return glm::vec3(x, y, -0.5f + slope * (x - kColumn - 0.5f)); };
        const glm::vec3 a = corner(-50, 50), b = corner(-50, -250), c = corner(250, -250), d = corner(250, 50);
        return std::array<Triangle, 2>{Triangle{a, b, c}, Triangle{a, c, d}};
    };
    for (int more : {0, 140}) { // with 284 triangles, more than a tile sorts
        std::vector<Triangle> triangles;
        for (const float slope : {0.0f, 1.0f / 512})
            for (const Triangle& t : quad(slope))
                triangles.push_back(t);
        for (int i = 0; i < more; ++i)
            triangles.insert(triangles.end(), {quad(0.0f)[0], quad(0.0f)[1]});
        const Stage stage(scene_of(triangles, true));
        FrameDesc d = id_desc(70, 50, 1);
        d.view.znear = 0.5f, d.view.zfar = 2.5f; // depths without rounding
        for (Isa isa : available_isas()) {
            const Frame f = stage.render(d, isa);
            for (std::size_t i = 0; i < f.triangle_ids.size(); ++i)
                ASSERT_EQ(f.triangle_ids[i] / 2, i % 70 > kColumn ? 1u : 0u) << i % 70 << " " << more << " " << isa_name(isa);
        }
    }
}

// Slivers have steep depths. Rounding must not depend on the tile.
TEST(coverage, tiles_of_32_and_64_agree_on_crossing_slivers)
{
    Random random{29};
    std::vector<Triangle> slivers;
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 a(random.unit() * 200, -random.unit() * 140, random.unit()),
            d(random.unit() * 90 - 45, random.unit() * 90 - 45, random.unit() - 0.5f);
        const glm::vec3 side(random.unit() * 0.6f, random.unit() * 0.6f, random.unit() - 0.5f);
        slivers.push_back({a, a + d, a + side});
    }
    for (int i = 0; i < 400; ++i) { // nearly coplanar: the last bit of depth decides
        const auto corner = [&] { return glm::vec3(random.unit() * 200, -random.unit() * 140, 0.5f + random.unit() * 4e-6f); };
        slivers.push_back({corner(), corner(), corner()});
    }
    const Stage stage(scene_of(slivers, true));
    FrameDesc d = id_desc(200, 140, 8);
    const Frame a = stage.render(d, best_isa());
    d.tile_size = 32;
    const Frame b = stage.render(d, best_isa());
    EXPECT_TRUE(std::equal(a.triangle_ids.begin(), a.triangle_ids.end(), b.triangle_ids.begin()));
}

// A wall behind the near plane must not appear, and the cut must lie at the plane.
TEST(coverage, near_plane_cuts_where_it_lies)
{
    // a floor at y = -1 seen from the origin: below the image's 45 degree edge ray alone is it nearer than znear = 2
    const Stage stage(scene_of({{glm::vec3(-50, -1, 50), glm::vec3(50, -1, 50), glm::vec3(50, -1, -50)},
                                {glm::vec3(-50, -1, 50), glm::vec3(50, -1, -50), glm::vec3(-50, -1, -50)}},
                               true));
    FrameDesc d = id_desc(100, 100, 1);
    d.view = make_view({0, 0, 0}, {0, 0, -1}, 1.5707963f, 100, 100);
    d.view.znear = 2.0f;
    for (Isa isa : available_isas()) {
        const Frame f = stage.render(d, isa);
        for (int y = 0; y < 100; ++y) {
            const float slope = (static_cast<float>(y) + 0.5f - 50.0f) / 50.0f; // distance of the floor along the view: 1 / slope
            const bool expected = slope > 1.0f / 50.0f && 1.0f / slope > 2.0f;
            EXPECT_EQ(f.triangle_ids[static_cast<std::size_t>(y * 100 + 50)] != kNothing, expected) << y;
        }
        for (const std::uint32_t id : f.triangle_ids) // clipped pieces keep their triangle's id
            ASSERT_TRUE(id == kNothing || id < 2) << id << " " << isa_name(isa);
    }
}

TEST(coverage, back_faces_are_culled_and_mirrored_instances_are_not)
{
    Scene scene = scene_of({{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)}}, false);
    FrameDesc d = id_desc(20, 20, 1);
    d.view = make_view({0, 0, 3}, {0, 0, 0}, 0.8f, 20, 20);
    const auto hits = [&](const Scene& s, const FrameDesc& desc) {
        const Frame f = Stage(s).render(desc, best_isa());
        return std::count_if(f.triangle_ids.begin(), f.triangle_ids.end(), [](std::uint32_t id) { return id != kNothing; });
    };
    const auto front = hits(scene, d);
    EXPECT_GT(front, 20);
    FrameDesc behind = d;
    behind.view = make_view({0, 0, -3}, {0, 0, 0}, 0.8f, 20, 20);
    EXPECT_EQ(hits(scene, behind), 0);
    scene.nodes[0].local = glm::mat4(1.0f);
    scene.nodes[0].local[0][0] = -1.0f; // mirrored in x: still seen from the front
    update_world(scene);
    EXPECT_EQ(hits(scene, d), front);
    EXPECT_EQ(hits(scene, behind), 0);
}

TEST(coverage, culling_never_changes_the_picture)
{
    Random random{5};
    const Stage stage(scene_of(tessellated_box(1.0f, 24), false)); // half the walls' clusters face away
    for (int k = 0; k < 12; ++k) {
        FrameDesc d = id_desc(80, 60, 1);
        const glm::vec3 eye(random.unit() * 6 - 3, random.unit() * 6 - 3, random.unit() * 6 - 3);
        d.view = make_view(eye, glm::vec3(random.unit(), random.unit(), random.unit()), 0.9f, 80, 60);
        const Frame culled = stage.render(d, best_isa());
        Stage all(stage.scene);
        for (Cluster& c : all.tables.clusters) {
            c.radius = 1e9f;
            c.cone_cutoff = 1.0f;
        }
        const Frame whole = all.render(d, best_isa());
        EXPECT_TRUE(std::equal(culled.triangle_ids.begin(), culled.triangle_ids.end(), whole.triangle_ids.begin())) << k;
    }
}

// Built-in scenes face outwards everywhere: from outside, back-face culling removes nothing.
TEST(coverage, builtin_scenes_are_not_inside_out)
{
    for (const char* name : {"teapot", "spheres", "plate"}) {
        Scene scene = *make_builtin_scene(name);
        const Stage culled(scene);
        for (Material& m : scene.materials)
            m.double_sided = true;
        const Stage both_sides(std::move(scene));
        FrameDesc d = id_desc(320, 200, 4);
        d.view = auto_frame(culled.tables, d.width, d.height);
        const Frame a = culled.render(d, best_isa()), b = both_sides.render(d, best_isa());
        std::size_t seen = 0, differ = 0;
        for (std::size_t i = 0; i < a.triangle_ids.size(); ++i) {
            seen += b.triangle_ids[i] != kNothing;
            differ += a.triangle_ids[i] != b.triangle_ids[i];
        }
        EXPECT_GT(seen, 20000u);
        EXPECT_LE(differ, seen / 1000) << name;
        std::printf("%s: %zu of %zu samples differ\n", name, differ, seen);
    }
}

} // namespace
} // namespace burnish::test
