// Disk cache for slow mip levels (seconds to minutes): from nets and optimisers, weighted or sharpened colours. Keys are hashes of the
// inputs.
#pragma once
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

// Makes mips.cached of materials whose filter takes_net(), and of coupled or sharper colours, or finds them in the cache
// (core/base/cache.h). A file there that is damaged, or of anything else, is made anew; a cache that cannot be written is a warning.
void cache_mips(Scene& scene, SceneMips& mips, const Jobs& jobs);

} // namespace burnish
