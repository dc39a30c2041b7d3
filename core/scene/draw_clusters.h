// Clusters of a draw: what make_draw_tables calls after a draw's triangles are in place.
#pragma once
#include <cstdint>

#include "core/scene/draw_tables.h"

namespace burnish {

// Appends the clusters of draws[draw]. Their bounds are conservative: culling by them removes no triangle
// that could be seen. double_sided: the cone never culls.
void append_clusters(DrawTables& tables, std::uint32_t draw, bool double_sided);

} // namespace burnish
