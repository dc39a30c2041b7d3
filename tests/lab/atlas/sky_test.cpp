// Queries of --risks to an environment and to the atlas.
#include <gtest/gtest.h>

#include "apps/lab/atlas/entries.h"
#include "apps/risks/risks.h"
#include "apps/risks/sky.h"
#include "core/simd/half.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {
namespace {

// A texel's direction finds the texel, on every face.
TEST(atlas_sky, texels_are_where_cubes_have_them)
{
    Environment environment;
    environment.specular = make_cube_map(8, 3, 2.0f);
    const Jobs jobs(1);
    for (int l = 0; l < 3; ++l) {
        const int side = 8 >> l;
        std::vector<float> rgb(cube_texels(side) * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i)
            rgb[i] = static_cast<float>(1 + l + 3 * (i / 3)); // grey
        store_cube_level(environment.specular, l, rgb.data(), jobs);
    }
    const Sky sky(environment);
    for (int l = 0; l < 3; ++l) {
        const int side = 8 >> l;
        for (int face = 0; face < 6; ++face)
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    const Direction d = cube_direction(face, (2.0 * x + 1.0) / side - 1.0, (2.0 * y + 1.0) / side - 1.0);
                    const glm::vec3 v(static_cast<float>(3.0 * d.x), static_cast<float>(3.0 * d.y), static_cast<float>(3.0 * d.z));
                    EXPECT_NEAR(sky.luminance(v, static_cast<float>(l) / 2.0f), 1 + l + 3 * ((face * side + y) * side + x), 1.0)
                        << l << ' ' << face << ' ' << x << ' ' << y;
                }
    }
}

TEST(atlas_risks, widths_of_entries_are_those_of_their_words)
{
    const auto inputs_at = [](const char* entry, double s) {
        return inputs_of_setting(setting_of(*find_entry(entry), AtlasRole::test, s, 64, 0)->options);
    };
    const char* bent = "bent_normal_bends_too_far"; // --roughness 0.4, anisotropy 0 to 0.95
    const RiskInputs none = inputs_at(bent, 0.0), most = inputs_at(bent, 1.0);
    EXPECT_FLOAT_EQ(none.along, 0.16f);
    EXPECT_FLOAT_EQ(none.across, 0.16f);
    EXPECT_FLOAT_EQ(most.along, 0.16f * 1.95f);
    EXPECT_NEAR(most.eta(), 0.95f, 1e-5f);
    EXPECT_NEAR(inputs_at("prefilter_knows_no_angle", 1.0).n_dot_v, 0.14f / 0.9131f, 1e-3f);
    EXPECT_NEAR(inputs_at("prefiltered_tilt", 1.0).tilt, 1.0472f, 1e-4f);
    EXPECT_EQ(inputs_at("mc_fireflies", 1.0).samples, 64.0f);
}

} // namespace
} // namespace burnish
