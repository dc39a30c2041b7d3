// Specular antialiasing widens lobes by the variation of normals between pixels: the amount on a uniformly bent surface, and none on a flat
// one.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/builtin/builtin.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr int kAaSide = 64;
constexpr double kFilter = 1.0 / 12.0; // variance of a pixel's box, square pixels

// Returns a plate whose normals lean by `slope` a metre along x.
Scene bent_plate(float slope)
{
    Scene scene = plate(1.0f);
    VertexTable& v = scene.vertices;
    const float length = std::sqrt(1.0f + slope * slope);
    for (std::size_t i = 0; i < v.size(); ++i)
        v.nx[i] = v.px[i] * slope / length, v.nz[i] = 1.0f / length;
    return scene;
}

FrameDesc seen_from_above()
{
    FrameDesc d;
    d.width = d.height = kAaSide, d.msaa = 4, d.layers = true, d.specular_aa = true;
    d.view = make_view({0, 0, 4}, {0, 0, 0}, 0.6f, kAaSide, kAaSide);
    return d;
}

float roughness_in_the_middle(const Frame& f)
{
    return f.layers[kAaSide / 2 * kAaSide + kAaSide / 2].roughness;
}

TEST(specular_aa, lobes_grow_by_the_covariance_of_a_pixel)
{
    const FrameDesc d = seen_from_above();
    const double pixel_m = 4.0 * 2.0 * double{d.view.tan_half_x} / kAaSide;
    for (float slope : {0.2f, 0.5f})
        for (float roughness : {0.0f, 0.2f}) {
            const double along2 = kFilter * std::pow(double{slope} * pixel_m, 2.0), sigma2 = std::pow(double{roughness}, 4.0) / 2.0;
            Scene scene = bent_plate(slope);
            scene.materials[0].roughness = roughness;
            const Stage round(scene);
            EXPECT_NEAR(roughness_in_the_middle(round.render(d, best_isa())), std::pow(2.0 * (sigma2 + along2 / 2.0), 0.25), 2e-3);
            scene.materials[0].anisotropy_strength = 1e-3f; // anisotropic, with nearly equal widths
            const Stage brushed(scene);
            const double mean = (std::sqrt(sigma2 + along2) + std::sqrt(std::max(sigma2, 5e-7))) / std::sqrt(2.0);
            EXPECT_NEAR(roughness_in_the_middle(brushed.render(d, best_isa())), std::sqrt(mean), 2e-3);
            FrameDesc off = d;
            off.specular_aa = false;
            EXPECT_NEAR(roughness_in_the_middle(round.render(off, best_isa())), roughness, 1e-4f);
        }
}

TEST(specular_aa, changes_nothing_where_nothing_bends)
{
    Scene scene = plate(1.0f);
    scene.materials[0].roughness = 0.3f;
    const Stage stage(std::move(scene));
    FrameDesc d = seen_from_above();
    const Frame with = stage.render(d, best_isa());
    d.specular_aa = false;
    const Frame without = stage.render(d, best_isa());
    for (int i = 0; i < 3 * kAaSide * kAaSide; ++i)
        ASSERT_NEAR(with.color.f32()[i], without.color.f32()[i], 2e-6f);
}

// Triangles of all sizes, at silhouettes and poles, by every technique.
TEST(specular_aa, makes_no_nan_and_the_same_bits_everywhere)
{
    for (const char* name : {"bumps", "spheres"}) {
        const Stage one(*make_builtin_scene(name), 1.0f, 1), three(*make_builtin_scene(name), 1.0f, 3);
        FrameDesc d;
        d.width = 60, d.height = 40, d.msaa = 2, d.specular_aa = true;
        d.view = auto_frame(one.tables, d.width, d.height);
        for (const TechniqueInfo& t : techniques()) {
            d.technique = t.name, d.samples = t.default_samples, d.tile_size = 64;
            const Frame first = one.render(d, best_isa());
            EXPECT_EQ(count_not_finite(first.color), 0u) << name << " " << t.name;
            d.tile_size = 32;
            for (Isa isa : available_isas())
                EXPECT_EQ(pixel_hash(three.render(d, isa).color), pixel_hash(first.color)) << name << " " << t.name;
        }
    }
}

} // namespace
} // namespace burnish::test
