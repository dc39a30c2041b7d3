// The page of the atlas.
#pragma once
#include <string>
#include <vector>

#include "apps/lab/atlas/kept.h"

namespace burnish {

// Beside it lie the strips of pictures, and nothing else is needed.
std::string atlas_page(const std::vector<AtlasResult>& results, const AtlasWalk& walk);

} // namespace burnish
