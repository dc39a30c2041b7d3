// Clusters that a view culls.
#include <gtest/gtest.h>

#include "raster/tile/cull.h"

namespace burnish {
namespace {

// Returns a cluster with radius 5 cm whose triangles face -Z within a sixth of a turn.
DrawTables ball_that_looks_away(glm::vec3 center)
{
    DrawTables tables;
    Draw draw;
    draw.bounds_min = center - 0.05f, draw.bounds_max = center + 0.05f;
    tables.draws.push_back(draw);
    Cluster cluster;
    cluster.center = center, cluster.radius = 0.05f, cluster.cone_axis = {0.0f, 0.0f, -1.0f}, cluster.cone_cutoff = 0.5f;
    tables.clusters.push_back(cluster);
    return tables;
}

// Counts the clusters that remain for the ball at z metres, seen from `distance` along +Z.
std::size_t clusters_seen_from(float distance, float z = 0.0f)
{
    View view;
    view.eye = {0.0f, 0.0f, z + distance};
    return cull(ball_that_looks_away({0.0f, 0.0f, z}), std::vector<MaterialRecord>(1), view).clusters.size();
}

// Floats step by 6 cm at six hundred kilometres, so rounding decides which way small triangles face.
TEST(cull, clusters_that_look_away_are_left_out_but_not_where_floats_do_not_hold_how_they_look)
{
    EXPECT_EQ(clusters_seen_from(1.0f), 0u);
    EXPECT_EQ(clusters_seen_from(100.0f), 0u);
    EXPECT_EQ(clusters_seen_from(1e4f), 1u);
    EXPECT_EQ(clusters_seen_from(6e5f), 1u);
}

// Positions are rounded after the eye is subtracted. The distance from the eye counts, and the origin does not.
TEST(cull, clusters_that_look_away_are_told_by_their_distance_from_the_eye_wherever_both_are)
{
    EXPECT_EQ(clusters_seen_from(6e5f, -6e5f), 1u); // the eye at the origin
    EXPECT_EQ(clusters_seen_from(6e5f, -3e5f), 1u);
    EXPECT_EQ(clusters_seen_from(1.0f, 1e6f), 0u); // both far from the origin, close together
    EXPECT_EQ(clusters_seen_from(1.0f, -1e6f), 0u);
    EXPECT_EQ(clusters_seen_from(100.0f, 1e6f), 0u);
}

} // namespace
} // namespace burnish
