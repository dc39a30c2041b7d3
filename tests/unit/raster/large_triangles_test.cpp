// Triangles that are thousands to 1e18 times larger than the near plane's distance. Coverage and interpolated values are checked
// against an oracle that neither clips nor snaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/simd/dispatch.h"
#include "raster/frame/exact_projection.h"
#include "raster/frame/frame_record.h"
#include "raster/tile/tile_types.h"
#include "shading/kernels/depth_plane.k.h"
#include "shading/kernels/interpolate.k.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

// Corners snap to a grid of 1/256 pixel, which moves an edge by at most .0028 pixel. Nothing else moves an edge.
constexpr double kEdge = 1.0 / 256.0; // pixels
// Values on a clipped piece equal the exact values at a place this near.
constexpr double kPlace = 1.0 / 256.0; // pixels
// Whole triangles end at most 15360 pixels away, and floats lose up to 2^-18 of this distance.
constexpr double kPlaceOfWhole = 1.0 / 16.0;    // pixels
constexpr double kPlaceOfParallel = 1.0 / 12.0; // pixels, in orthographic views
constexpr double kRounding = 0x1p-20;           // relative to a value and to the largest weight

// One triangle through the front end of an instruction set.
class OneTriangle {
  public:
    explicit OneTriangle(Isa isa)
        : fns_(*find_fns<TileFns>(isa)), indices_(3), materials_of_(1), entries_(kRoom), runs_(kRoom), pieces_(kRoom)
    {
        for (std::uint32_t k = 0; k < 3; ++k)
            indices_.data()[k] = k;
        for (Column<float>* c : {&px_, &py_, &pz_})
            c->resize(3);
        vertices_.resize(3);
        material_.double_sided = 1;
    }
    // Returns the whole triangle's setup, or the setups of its pieces after clipping.
    const std::vector<ClippedPiece>& draw(const View& view, int width, int height, const glm::vec3 corners[3])
    {
        FrameParams f = {};
        f.view = view_record(view);
        f.width = width, f.height = height, f.msaa = 1;
        f.center_x = width / 2 * kSubpixel, f.center_y = height / 2 * kSubpixel;
        f.half_width = 0.5f * static_cast<float>(width), f.half_height = 0.5f * static_cast<float>(height);
        f.pattern.min_x = f.pattern.min_y = 0, f.pattern.max_x = f.pattern.max_y = kSubpixel; // any place in a pixel
        f.tile_size = f.tile_step = 64, f.tiles_x = (width + 63) / 64, f.tiles_y = (height + 63) / 64;
        for (std::size_t k = 0; k < 3; ++k)
            px_.data()[k] = corners[k].x, py_.data()[k] = corners[k].y, pz_.data()[k] = corners[k].z;
        f.px = px_.data(), f.py = py_.data(), f.pz = pz_.data();
        f.vertices = vertices_.data(), f.indices = indices_.data();
        f.materials = &material_, f.triangle_material = materials_of_.data();
        ChunkOutput out = {};
        out.entries = entries_.data(), out.runs = runs_.data(), out.pieces = pieces_.data();
        out.capacity = out.piece_capacity = kRoom;
        fns_.transform_vertices(f, 0, 3);
        fns_.bin_triangles(f, 0, 1, out);
        frame = f;
        drawn_.assign(pieces_.data(), pieces_.data() + out.piece_count);
        if (out.count > 0 && out.piece_count == 0)
            drawn_.push_back(whole());
        return drawn_;
    }
    FrameParams frame;

  private:
    static constexpr std::uint32_t kRoom = 2 * kGrowRoom;
    ClippedPiece whole() const
    {
        ClippedPiece p = {};
        const SnappedVertex* const v = vertices_.data();
        const std::int64_t area = std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y) - std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y);
        for (int j = 0; j < 3; ++j) {
            const int from = area < 0 && j > 0 ? 3 - j : j;
            p.setup.x[j] = v[from].x, p.setup.y[j] = v[from].y, p.setup.inv_w[j] = v[from].inv_w, p.setup.z[j] = v[from].z;
            p.record.bary[3 * j + from] = 1.0f;
        }
        p.setup.info = area < 0 ? kFrontFacing : 0;
        return p;
    }
    const TileFns& fns_;
    Column<std::uint32_t> indices_, materials_of_;
    Column<float> px_, py_, pz_;
    Column<SnappedVertex> vertices_;
    Column<std::uint32_t> entries_;
    std::vector<TileRun> runs_;
    std::vector<ClippedPiece> pieces_, drawn_;
    MaterialRecord material_ = {};
};

// Returns true where a piece covers a place (1/256 pixel from the centre pixel). Edges belong to the piece.
bool piece_covers(const TriangleSetup& t, int x, int y)
{
    for (int i = 0; i < 3; ++i) {
        const int p = (i + 1) % 3, q = (i + 2) % 3;
        if (std::int64_t{t.y[p] - t.y[q]} * (x - t.x[p]) + std::int64_t{t.x[q] - t.x[p]} * (y - t.y[p]) < 0)
            return false;
    }
    return true;
}

struct WorstOfLarge { // over all places tested
    std::size_t triangles = 0, cut = 0, places = 0, covered = 0, differing = 0;
    double edge_px = 0.0;                                          // largest distance to an edge where coverage differs
    double w_px = 0.0, depth_px = 0.0, b_px = 0.0, whole_px = 0.0; // distance to the place with the value found
};

// Returns the distance in pixels that explains the error of a value with this slope, after rounding.
double pixels_away(Long error, Long rounding, Long slope)
{
    const Long left = std::fabs(error) - rounding;
    return left <= 0 ? 0.0 : static_cast<double>(left / slope);
}

void look_at_values(const FrameParams& f, const ClippedPiece& piece, const ProjectedTriangle& exact, int x, int y, double placed,
                    WorstOfLarge& worst)
{
    const Long px = Long(x + f.center_x) / kSubpixel, py = Long(y + f.center_y) / kSubpixel;
    triangle_setup t = {};
    const TriangleSetup& s = piece.setup;
    for (int k = 0; k < 3; ++k) {
        t.x[k] = s.x[k], t.y[k] = s.y[k];
        t.unclip[k] = vec3_of(piece.record.bary[3 * k], piece.record.bary[3 * k + 1], piece.record.bary[3 * k + 2]);
    }
    t.inv_w = vec3_of(s.inv_w[0], s.inv_w[1], s.inv_w[2]);
    t.info = s.info, t.piece = t.clipped = (s.info & kClipped) != 0;
    const bary_weights w = weights_at(t, x, y);
    const Long inv_w = exact.inv_w.value(px, py), slope = exact.inv_w.slope();
    if (t.clipped)
        worst.w_px = std::max(worst.w_px, pixels_away(1 / Long(w.w) - inv_w, kRounding * inv_w, slope));
    double right = 0.0, down = 0.0;
    depth_slopes(double(s.x[1] - s.x[0]), double(s.y[1] - s.y[0]), double(s.x[2] - s.x[0]), double(s.y[2] - s.y[0]),
                 double(s.z[1]) - double(s.z[0]), double(s.z[2]) - double(s.z[0]), right, down);
    const double z = std::fmin(std::fmax(depth_at(double(s.z[0]), right, down, double(x - s.x[0]), double(y - s.y[0])),
                                         double(std::min(s.z[0], std::min(s.z[1], s.z[2])))),
                               double(std::max(s.z[0], std::max(s.z[1], s.z[2]))));
    const Long nearness = f.view.orthographic ? 1 : exact.z.value(px, py); // depth's rounding is relative to it
    worst.depth_px = std::max(worst.depth_px, pixels_away(z - exact.z.value(px, py), kRounding * nearness, exact.z.slope()));
    // Weights are the shares divided by inv_w. The allowed change per pixel is doubled.
    if (inv_w < 4 * kPlaceOfWhole * slope)
        return; // at the horizon
    const real3 b = w.b;
    const float found[3] = {t.clipped ? b.x : 0, t.clipped ? b.y : 0, t.clipped ? b.z : 0};
    float of_whole[3] = {found[0], found[1], found[2]};
    if (!t.clipped) {
        const float corner[3] = {b.x, b.y, b.z};
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                of_whole[k] += piece.record.bary[3 * j + k] * corner[j];
    }
    for (int k = 0; k < 3; ++k) {
        const Linear& share = exact.share[k];
        const Long expected = share.value(px, py) / inv_w;
        const Long by_x = (share.by_x - expected * exact.inv_w.by_x) / inv_w, by_y = (share.by_y - expected * exact.inv_w.by_y) / inv_w;
        double& b_px = t.clipped ? worst.b_px : worst.whole_px;
        b_px = std::max(b_px, pixels_away(of_whole[k] - expected, kRounding, 2 * std::hypot(by_x, by_y)) - (t.clipped ? 0.0 : placed));
    }
}

void look_at(OneTriangle& renderer, const View& view, int width, int height, const glm::vec3 corners[3], int places, bool values,
             Random& random, WorstOfLarge& worst)
{
    const std::vector<ClippedPiece>& pieces = renderer.draw(view, width, height, corners);
    const ProjectedTriangle exact = project(renderer.frame.view, width, height, corners);
    ++worst.triangles;
    worst.cut += !pieces.empty() && (pieces[0].setup.info & kClipped);
    if (!exact.seen_at_all)
        return;
    // Corners within the guard band are placed in floats. An orthographic view magnifies corners that are far away along its axis.
    double placed = 0.0; // pixels
    for (int k = 0; k < 3 && view.orthographic; ++k) {
        const double far = glm::length(glm::dvec3(corners[k]) - glm::dvec3(view.eye)) / static_cast<double>(view.tan_half_y);
        placed = std::max(placed, 0x1p-22 * far * 0.5 * height);
    }
    for (int n = 0; n < places; ++n) {
        const int sub_x = random.below(width * kSubpixel), sub_y = random.below(height * kSubpixel);
        const int x = sub_x - renderer.frame.center_x, y = sub_y - renderer.frame.center_y;
        const ClippedPiece* found = nullptr;
        for (const ClippedPiece& piece : pieces)
            if (!found && piece_covers(piece.setup, x, y))
                found = &piece;
        const Long inside = exact.inside(Long(sub_x) / kSubpixel, Long(sub_y) / kSubpixel);
        ++worst.places;
        worst.covered += found != nullptr;
        if ((found != nullptr) != (inside >= 0)) {
            ++worst.differing;
            worst.edge_px = std::max(worst.edge_px, static_cast<double>(std::fabs(inside)) - placed);
        } else if (values && found && inside > kEdge + placed) {
            look_at_values(renderer.frame, *found, exact, x, y, placed, worst);
        }
    }
}

void expect_right(const WorstOfLarge& w, double place_of_whole)
{
    std::printf(
        "%zu triangles, %zu of them cut; of %zu places %zu are covered, %zu differ, at most %.2g pixel from an edge; values are those "
        "of places %.2g (w), %.2g (depth), %.2g (weights) pixel away, of whole triangles %.2g\n",
        w.triangles, w.cut, w.places, w.covered, w.differing, w.edge_px, w.w_px, w.depth_px, w.b_px, w.whole_px);
    EXPECT_LE(w.edge_px, kEdge);
    EXPECT_LE(w.w_px, kPlace);
    EXPECT_LE(w.depth_px, kPlace);
    EXPECT_LE(w.b_px, kPlace);
    EXPECT_LE(w.whole_px, place_of_whole);
    EXPECT_GT(w.covered, w.places / 20);
}

double exponential(Random& random, double least, double most)
{
    return least * std::pow(most / least, static_cast<double>(random.unit()));
}
glm::dvec3 any_direction(Random& random)
{
    for (;;) {
        const glm::dvec3 d(2.0 * static_cast<double>(random.unit()) - 1.0, 2.0 * static_cast<double>(random.unit()) - 1.0,
                           2.0 * static_cast<double>(random.unit()) - 1.0);
        const double n = glm::length(d);
        if (n > 0.1 && n < 1.0)
            return d / n;
    }
}

enum Kind { floor_below, upright, through_space, around_the_eye, sliver, kKinds };

// Draws corners within `extent` metres, seen from an eye `height` metres above their plane, or anywhere.
void random_corners(Random& random, int kind, double extent, double height, const glm::dvec3& eye, glm::vec3 corners[3])
{
    glm::dvec3 n = kind == floor_below ? glm::dvec3(0, 1, 0) : any_direction(random);
    const glm::dvec3 side = std::fabs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(side, n)), v = glm::cross(n, u);
    const double turned = 6.283185307 * static_cast<double>(random.unit());
    for (int k = 0; k < 3; ++k) {
        const double angle = turned + 2.0943951 * (k + (kind == around_the_eye ? 0.0 : 0.8 * static_cast<double>(random.unit())));
        double far = kind == around_the_eye ? extent : exponential(random, 0.01 * extent, extent);
        glm::dvec3 p = eye - height * n + far * (std::cos(angle) * u + std::sin(angle) * v);
        if (kind == through_space)
            p = eye + extent * static_cast<double>(random.unit()) * any_direction(random);
        corners[k] = glm::vec3(p);
    }
    if (kind == sliver) // width: a hundredth to a millionth of the length
        corners[2] = corners[1] + glm::vec3(exponential(random, 1e-6, 1e-2) * extent * any_direction(random));
}

void random_triangles(Isa isa, std::uint64_t seed, int count, int places, bool orthographic)
{
    Random random{seed};
    OneTriangle renderer(isa);
    WorstOfLarge worst;
    constexpr int kSizes[][2] = {{640, 360}, {512, 512}, {96, 96}, {333, 77}, {1920, 1080}};
    for (int n = 0; n < count; ++n) {
        const auto& size = kSizes[random.below(5)];
        const double extent = exponential(random, 1e2, n % 4 ? 1e7 : 1e12), height = exponential(random, 1e-2, 0.1 * extent);
        const glm::vec3 eye(any_direction(random) * exponential(random, 1e-3, 1e2));
        glm::vec3 corners[3];
        random_corners(random, random.below(kKinds), extent, height, glm::dvec3(eye), corners);
        const float fov = 0.3f + 1.6f * random.unit();
        // Looks in any direction, or at a place on the triangle.
        glm::dvec3 towards = any_direction(random);
        const double a = static_cast<double>(random.unit()), b = (1.0 - a) * static_cast<double>(random.unit());
        const glm::dvec3 place = glm::dvec3(corners[0]) * a + glm::dvec3(corners[1]) * b + glm::dvec3(corners[2]) * (1.0 - a - b);
        if (random.below(4) && glm::length(place - glm::dvec3(eye)) > 1e-3)
            towards = glm::normalize(place - glm::dvec3(eye)) + 0.3 * towards;
        View view = make_view(eye, glm::vec3(glm::dvec3(eye) + towards * 1e3), fov, size[0], size[1]);
        view.znear = static_cast<float>(exponential(random, 1e-6, 1.0));
        if (orthographic) {
            view.orthographic = true;
            view.tan_half_y = static_cast<float>(exponential(random, 1e-2 * extent, extent)); // metres
            view.tan_half_x = view.tan_half_y * static_cast<float>(size[0]) / static_cast<float>(size[1]);
            view.zfar = 3.0f * static_cast<float>(extent);
        }
        look_at(renderer, view, size[0], size[1], corners, places, extent < 1e7, random, worst);
    }
    expect_right(worst, orthographic ? kPlaceOfParallel : kPlaceOfWhole);
    EXPECT_GT(worst.cut, static_cast<std::size_t>(count) / 5);
}

TEST(large_triangles, are_those_of_rays)
{
    for (const Isa isa : available_isas())
        random_triangles(isa, 11, isa == best_isa() ? 10000 : 2000, 24, false);
}

TEST(large_triangles, are_those_of_parallel_rays)
{
    for (const Isa isa : available_isas())
        random_triangles(isa, 13, isa == best_isa() ? 10000 : 2000, 24, true);
}

TEST(large_triangles, million_are_those_of_rays)
{
    random_triangles(best_isa(), 12, 1000000, 24, false);
    random_triangles(best_isa(), 14, 1000000, 24, true);
}

// Checks a square floor of two triangles: every sample of whole frames, with triangle ids.
void look_at_floor(double extent, float height, float pitch, float roll, float znear, int width, int height_px, int msaa)
{
    const float e = static_cast<float>(extent);
    const std::vector<Triangle> triangles = {{glm::vec3(-e, 0, e), glm::vec3(e, 0, e), glm::vec3(e, 0, -e)},
                                             {glm::vec3(-e, 0, e), glm::vec3(e, 0, -e), glm::vec3(-e, 0, -e)}};
    const Stage stage(scene_of(triangles, true));
    FrameDesc desc;
    desc.width = width, desc.height = height_px, desc.msaa = msaa, desc.triangle_ids = true;
    desc.technique = "split_isotropic";
    desc.view = make_view(glm::vec3(0, height, 0), glm::vec3(0, height - std::tan(pitch), -1), 0.7f, width, height_px);
    const glm::vec3 right = desc.view.right, up = desc.view.up;
    desc.view.right = std::cos(roll) * right + std::sin(roll) * up, desc.view.up = std::cos(roll) * up - std::sin(roll) * right;
    desc.view.znear = znear;
    const ViewRecord view = view_record(desc.view);
    const ProjectedTriangle exact[2] = {project(view, width, height_px, triangles[0].data()),
                                        project(view, width, height_px, triangles[1].data())};
    const SamplePattern pattern = standard_samples(msaa);
    for (const Isa isa : {Isa::scalar, best_isa()}) {
        const Frame frame = stage.render(desc, isa);
        double farthest = 0.0;
        std::size_t covered = 0;
        for (std::size_t i = 0; i < frame.triangle_ids.size(); ++i) {
            const std::size_t pixel = i / static_cast<std::size_t>(msaa), s = i % static_cast<std::size_t>(msaa);
            const Long x = Long(pixel % static_cast<std::size_t>(width)) + Long(pattern.x[s]) / kSubpixel;
            const Long y = Long(pixel / static_cast<std::size_t>(width)) + Long(pattern.y[s]) / kSubpixel;
            const std::uint32_t id = frame.triangle_ids.data()[i];
            covered += id != kNoTriangle;
            for (std::uint32_t k = 0; k < 2; ++k) {
                const Long inside = exact[k].inside(x, y);
                if ((id == k) != (inside >= 0))
                    farthest = std::max(farthest, static_cast<double>(std::fabs(inside)));
            }
        }
        EXPECT_LE(farthest, kEdge) << "extent " << extent << ", eye at " << height << ", pitch " << pitch << ", near plane " << znear
                                   << ", " << width << "x" << height_px << ", " << isa_name(isa);
        EXPECT_GT(covered, frame.triangle_ids.size() / 8);
    }
}

TEST(large_triangles, that_are_floors_cover_all_below_the_horizon)
{
    constexpr int kSizes[][2] = {{160, 90}, {128, 128}, {96, 96}, {97, 31}};
    int n = 0;
    for (const double extent : {1e2, 5e4, 1e5, 2e5, 1e7})
        for (const float znear : {1e-4f, 0.01f, 1.0f})
            for (const float pitch : {0.15f, 0.9f}) {
                const auto& size = kSizes[n++ % 4];
                look_at_floor(extent, znear < 0.5f ? 1.7f : 10.0f, pitch, n % 3 ? 0.0f : 0.4f, znear, size[0], size[1], n % 2 ? 4 : 1);
            }
}

// From inside a closed box every sample sees a wall, however large the box is.
TEST(large_triangles, that_close_a_box_leave_no_crack)
{
    Random random{3};
    for (const float half : {1e4f, 1e6f}) {
        const Stage stage(scene_of(tessellated_box(half, 3), true));
        for (int k = 0; k < 12; ++k) {
            glm::vec3 eye(random.unit(), random.unit(), random.unit());
            eye = (2.0f * eye - 1.0f) * half * 0.999f;
            eye[k % 3] = (k % 2 ? half : -half) * (1.0f - 1e-6f); // within a few metres of a wall
            const glm::vec3 target = (2.0f * glm::vec3(random.unit(), random.unit(), random.unit()) - 1.0f) * half;
            FrameDesc desc;
            desc.width = 97, desc.height = 61, desc.msaa = 4, desc.triangle_ids = true, desc.technique = "split_isotropic";
            desc.view = make_view(eye, target, k % 3 == 0 ? 2.6f : 1.0f, desc.width, desc.height);
            desc.view.znear = 0.001f;
            for (const Isa isa : {Isa::scalar, best_isa()}) {
                const Frame f = stage.render(desc, isa);
                EXPECT_EQ(std::count(f.triangle_ids.begin(), f.triangle_ids.end(), kNoTriangle), 0)
                    << isa_name(isa) << ", half a side of " << half << " m, view " << k;
            }
        }
    }
}

} // namespace
} // namespace burnish::test
