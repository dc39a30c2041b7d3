// The page of the atlas.
#pragma once
#include <string>
#include <vector>

#include "apps/lab/atlas/result_cache.h"

namespace burnish {

// Returns the page. The strips of pictures lie beside the page; no other file is needed.
// live: scripts of a page with the renderer inside, by the entries' names; or "".
std::string atlas_page(const std::vector<AtlasResult>& results, const AtlasWalk& walk, const std::string& live = "");

} // namespace burnish
