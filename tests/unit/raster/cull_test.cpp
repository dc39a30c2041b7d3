// Which clusters a view leaves out.
#include <gtest/gtest.h>

#include "raster/tile/cull.h"

namespace burnish {
namespace {

// Triangles of a ball of 10 cm that all look along -Z but for a sixth of a turn.
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

// Of the ball at z metres by an eye so far from it along +Z.
std::size_t clusters_seen_from(float distance, float z = 0.0f)
{
    View view;
    view.eye = {0.0f, 0.0f, z + distance};
    return cull(ball_that_looks_away({0.0f, 0.0f, z}), view).clusters.size();
}

// A float of a place six hundred kilometres away is a step of 6 cm: which way triangles of a centimetre look follows from how they are
// rounded.
TEST(cull, clusters_that_look_away_are_left_out_but_not_where_floats_do_not_hold_how_they_look)
{
    EXPECT_EQ(clusters_seen_from(1.0f), 0u);
    EXPECT_EQ(clusters_seen_from(100.0f), 0u);
    EXPECT_EQ(clusters_seen_from(1e4f), 1u);
    EXPECT_EQ(clusters_seen_from(6e5f), 1u);
}

// Places are rounded once the eye is taken from them: what counts is how far it is from them, not where both are.
TEST(cull, clusters_that_look_away_are_told_by_their_distance_from_the_eye_wherever_both_are)
{
    EXPECT_EQ(clusters_seen_from(6e5f, -6e5f), 1u); // the eye at the origin
    EXPECT_EQ(clusters_seen_from(6e5f, -3e5f), 1u);
    EXPECT_EQ(clusters_seen_from(1.0f, 1e6f), 0u); // both far from it, close together
    EXPECT_EQ(clusters_seen_from(1.0f, -1e6f), 0u);
    EXPECT_EQ(clusters_seen_from(100.0f, 1e6f), 0u);
}

} // namespace
} // namespace burnish
