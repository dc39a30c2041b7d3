// Which clusters a view leaves out.
#include <gtest/gtest.h>

#include "raster/tile/cull.h"

namespace burnish {
namespace {

// Triangles of a ball of 10 cm that all look along -Z but for a sixth of a turn.
DrawTables ball_that_looks_away()
{
    DrawTables tables;
    Draw draw;
    draw.bounds_min = glm::vec3(-0.05f), draw.bounds_max = glm::vec3(0.05f);
    tables.draws.push_back(draw);
    Cluster cluster;
    cluster.radius = 0.05f, cluster.cone_axis = {0.0f, 0.0f, -1.0f}, cluster.cone_cutoff = 0.5f;
    tables.clusters.push_back(cluster);
    return tables;
}

std::size_t clusters_seen_from(float distance)
{
    View view;
    view.eye = {0.0f, 0.0f, distance};
    return cull(ball_that_looks_away(), view).clusters.size();
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

} // namespace
} // namespace burnish
