// Clusters of a draw. make_draw_tables calls this after placing a draw's triangles.
#pragma once
#include <cstdint>

#include "core/scene/draw_tables.h"

namespace burnish {

// Appends the clusters of draws[draw]. The bounds are conservative: culling removes no visible triangle. double_sided:
// the cone never culls.
void append_clusters(DrawTables& tables, std::uint32_t draw, bool double_sided);

} // namespace burnish
