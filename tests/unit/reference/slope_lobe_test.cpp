// Lobes that heights are fitted by: lobes come back from their own slopes, and a ray-traced patch of heights reflects like its lobe.
#include "shading/bake/tables/slope_lobe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math/scalar_math.h"
#include "raster/reference/embree_scene.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

glm::dvec2 turned(double x, double y, double angle)
{
    return {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y};
}

TEST(slope_lobe, of_its_own_slopes_comes_back)
{
    for (const SlopeModel model : {SlopeModel::ggx, SlopeModel::beckmann}) {
        Random random{9};
        std::vector<glm::dvec2> slopes;
        for (int i = 0; i < 200000; ++i) {
            const double u = static_cast<double>(random.unit()), angle = 2.0 * kPi * static_cast<double>(random.unit());
            const double r = model == SlopeModel::ggx ? std::sqrt(u / (1.0 - u)) : std::sqrt(-std::log(1.0 - u));
            slopes.push_back(glm::dvec2(0.1, -0.05) + turned(0.4 * r * std::cos(angle), 0.1 * r * std::sin(angle), 0.6));
        }
        const SlopeLobe lobe = fit_slope_lobe(slopes, model);
        EXPECT_NEAR(lobe.alpha_along, 0.4, 0.004);
        EXPECT_NEAR(lobe.alpha_across, 0.1, 0.001);
        EXPECT_NEAR(lobe.angle, 0.6, 0.01);
        EXPECT_NEAR(lobe.mean.x, 0.1, 0.003);
        EXPECT_NEAR(lobe.mean.y, -0.05, 0.003);
        EXPECT_LT(lobe.distance, 0.02);
    }
}

TEST(slope_lobe, of_a_plane_or_one_slope_is_finite)
{
    for (const SlopeModel model : {SlopeModel::ggx, SlopeModel::beckmann})
        for (const std::vector<glm::dvec2>& slopes : {std::vector<glm::dvec2>(100, glm::dvec2(0.0)), {glm::dvec2(3.0, -4.0)}}) {
            const SlopeLobe lobe = fit_slope_lobe(slopes, model);
            EXPECT_TRUE(lobe.alpha_along > 0.0 && lobe.alpha_across > 0.0 && lobe.alpha_along < 1e-5);
            EXPECT_EQ(lobe.mean, slopes[0]);
            EXPECT_TRUE(std::isfinite(lobe.distance));
        }
}

constexpr int kSide = 160; // heights along a patch's side

using Field = std::vector<double>; // of one patch that repeats; in steps between heights

double periodic(double d) // the nearest of a point's repetitions
{
    return d - std::floor(d + 0.5);
}

Field field_of(const std::function<double(double, double)>& height)
{
    Field f;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            f.push_back(kSide * height(static_cast<double>(x) / kSide, static_cast<double>(y) / kSide));
    return f;
}

// Grooves along y of many widths: waves whose crests run nearly along it.
Field brushed()
{
    Random random{3};
    std::vector<glm::dvec3> waves; // turns a patch along x and y, phase
    for (int i = 0; i < 120; ++i)
        waves.emplace_back(1 + random.below(32), random.below(9) - 4, 2.0 * kPi * static_cast<double>(random.unit()));
    return field_of([&](double x, double y) {
        double sum = 0.0;
        for (const glm::dvec3& w : waves)
            sum += std::cos(2.0 * kPi * (w.x * x + w.y * y) + w.z) / w.x;
        return 0.004 * sum;
    });
}

// The deepest of many round dents.
Field dented(int count, double radius, double depth)
{
    Random random{5};
    std::vector<glm::dvec3> dents;
    for (int i = 0; i < count; ++i) {
        const double x = static_cast<double>(random.unit()), y = static_cast<double>(random.unit());
        dents.emplace_back(x, y, radius * (0.6 + 0.8 * static_cast<double>(random.unit())));
    }
    return field_of([&](double x, double y) {
        double least = 0.0;
        for (const glm::dvec3& d : dents) {
            const double dx = periodic(x - d.x), dy = periodic(y - d.y), r2 = (dx * dx + dy * dy) / (d.z * d.z);
            least = std::min(least, depth * d.z * (r2 - 1.0));
        }
        return least;
    });
}

double at(const Field& f, int x, int y)
{
    return f[static_cast<std::size_t>(((y % kSide) + kSide) % kSide * kSide + ((x % kSide) + kSide) % kSide)];
}

std::vector<glm::dvec2> slopes_of(const Field& f)
{
    std::vector<glm::dvec2> slopes;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double a = at(f, x, y), b = at(f, x + 1, y), c = at(f, x, y + 1), d = at(f, x + 1, y + 1);
            slopes.emplace_back(b - a, c - a), slopes.emplace_back(d - c, d - b);
        }
    return slopes;
}

// Three patches along each side, so that rays near the middle one meet no edge.
std::vector<Triangle> patches_of(const Field& f)
{
    std::vector<Triangle> triangles;
    const auto corner = [&](int x, int y) { return glm::vec3(glm::dvec3(x, y, at(f, x, y))); };
    for (int y = -kSide; y < 2 * kSide; ++y)
        for (int x = -kSide; x < 2 * kSide; ++x) {
            triangles.push_back({corner(x, y), corner(x + 1, y), corner(x, y + 1)});
            triangles.push_back({corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)});
        }
    return triangles;
}

constexpr int kCells = 16; // along a side of the square around all directions seen from above

using Picture = std::vector<double>; // energy by cell, of light from one direction

std::size_t cell_of(double x, double y)
{
    const auto index = [](double v) { return std::min(kCells - 1, static_cast<int>((v + 1.0) * 0.5 * kCells)); };
    return static_cast<std::size_t>(index(y) * kCells + index(x));
}

// Reflects rays towards `o` off mirrors at the heights, once.
Picture traced(const RayScene& scene, double top, const glm::dvec3& o, int packets)
{
    Picture energy(kCells * kCells, 0.0);
    Random random{11};
    const double share = 1.0 / (static_cast<double>(packets) * kRays);
    for (int p = 0; p < packets; ++p) {
        RayPacket rays = {};
        for (int i = 0; i < kRays; ++i) {
            rays.org_x[i] = kSide * random.unit(), rays.org_y[i] = kSide * random.unit(), rays.org_z[i] = static_cast<float>(top);
            rays.dir_x[i] = static_cast<float>(-o.x), rays.dir_y[i] = static_cast<float>(-o.y), rays.dir_z[i] = static_cast<float>(-o.z);
            rays.tnear[i] = 0.0f, rays.tfar[i] = 1e30f, rays.mask[i] = ~0u, rays.geometry[i] = kNoHit, rays.valid[i] = -1;
        }
        scene.trace(rays, RayKind::bounce);
        RayPacket out = rays;
        glm::dvec3 ways[kRays];
        for (int i = 0; i < kRays; ++i) {
            out.valid[i] = 0;
            if (rays.geometry[i] == kNoHit)
                continue;
            glm::dvec3 n = glm::normalize(glm::dvec3(rays.ng_x[i], rays.ng_y[i], rays.ng_z[i]));
            n = n.z < 0.0 ? -n : n;
            ways[i] = 2.0 * glm::dot(n, o) * n - o;
            if (glm::dot(n, o) <= 0.0 || ways[i].z <= 0.0)
                continue;
            const double t = static_cast<double>(rays.tfar[i]);
            const glm::dvec3 place = glm::dvec3(rays.org_x[i], rays.org_y[i], rays.org_z[i]) - o * t + n * 1e-3;
            out.org_x[i] = static_cast<float>(place.x), out.org_y[i] = static_cast<float>(place.y),
            out.org_z[i] = static_cast<float>(place.z);
            out.dir_x[i] = static_cast<float>(ways[i].x), out.dir_y[i] = static_cast<float>(ways[i].y);
            out.dir_z[i] = static_cast<float>(ways[i].z);
            out.tnear[i] = 0.0f, out.tfar[i] = 1e30f, out.mask[i] = ~0u, out.geometry[i] = kNoHit, out.valid[i] = -1;
        }
        scene.trace(out, RayKind::occlusion);
        for (int i = 0; i < kRays; ++i)
            if (out.valid[i] != 0 && out.tfar[i] > 0.0f)
                energy[cell_of(ways[i].x, ways[i].y)] += share;
    }
    return energy;
}

// Smith's Lambda of Beckmann's slopes with an axis upright.
double lambda(const SlopeLobe& lobe, const glm::dvec3& w)
{
    const glm::dvec2 across = turned(w.x, w.y, -lobe.angle);
    const double wide = std::hypot(lobe.alpha_along * across.x, lobe.alpha_across * across.y);
    const double a = w.z / std::max(wide, 1e-12);
    return 0.5 * (std::erf(a) - 1.0) + std::exp(-a * a) / (2.0 * a * std::sqrt(kPi));
}

// Sums the lobe's reflection of light towards `o` over each cell.
Picture reflected(const SlopeLobe& lobe, const glm::dvec3& o)
{
    constexpr int kParts = 48;
    Picture energy(kCells * kCells, 0.0);
    const int count = kCells * kParts;
    const double area = 4.0 / (static_cast<double>(count) * count);
    for (int j = 0; j < count; ++j)
        for (int i = 0; i < count; ++i) {
            const double x = 2.0 * (i + 0.5) / count - 1.0, y = 2.0 * (j + 0.5) / count - 1.0, rest = 1.0 - x * x - y * y;
            if (rest <= 1e-9)
                continue;
            const glm::dvec3 w(x, y, std::sqrt(rest)), h = glm::normalize(w + o);
            const glm::dvec2 s = turned(-h.x / h.z - lobe.mean.x, -h.y / h.z - lobe.mean.y, -lobe.angle);
            const double q = s.x * s.x / (lobe.alpha_along * lobe.alpha_along) + s.y * s.y / (lobe.alpha_across * lobe.alpha_across);
            const double d = std::exp(-q) / (kPi * lobe.alpha_along * lobe.alpha_across * std::pow(h.z, 4.0));
            energy[cell_of(x, y)] += d / (4.0 * o.z * (1.0 + lambda(lobe, o) + lambda(lobe, w))) * area / w.z;
        }
    return energy;
}

// Returns the largest L1 over views between a ray-traced patch and its lobe, relative to the patch's energy.
double worst_distance(const Field& field)
{
    const SlopeLobe lobe = fit_slope_lobe(slopes_of(field), SlopeModel::beckmann);
    const Scene scene = scene_of(patches_of(field), true);
    const Result<std::unique_ptr<RayScene>> rays = make_embree_scene(scene, make_draw_tables(scene), Jobs(1));
    EXPECT_TRUE(rays);
    const double top = *std::max_element(field.begin(), field.end()) + 1e-3;
    double worst = 0.0;
    for (const glm::dvec2 view : {glm::dvec2(0.1, 0.0), {0.6, 0.5}, {0.6, 2.0}, {1.0, 1.2}}) {
        const glm::dvec3 o(std::sin(view.x) * std::cos(view.y), std::sin(view.x) * std::sin(view.y), std::cos(view.x));
        const Picture a = traced(**rays, top, o, 6000), b = reflected(lobe, o);
        double difference = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            difference += std::abs(a[i] - b[i]), sum += a[i];
        worst = std::max(worst, difference / sum);
    }
    return worst;
}

TEST(slope_lobe, reflects_like_a_ray_traced_patch)
{
    if (!embree_available())
        GTEST_SKIP() << "built without Embree";
    EXPECT_LT(worst_distance(brushed()), 0.15);
    EXPECT_LT(worst_distance(dented(900, 0.035, 0.28)), 0.15) << "sand-blasted";
    EXPECT_LT(worst_distance(dented(90, 0.13, 0.16)), 0.15) << "hammered";
}

} // namespace
} // namespace burnish::test
