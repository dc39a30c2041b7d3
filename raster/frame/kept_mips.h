// Disk cache for slow mip levels (seconds to minutes): from nets and optimisers, weighted or sharpened colours. Keys are hashes of the
// inputs.
#pragma once
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"

namespace burnish {

// Fills scene.kept_mips for materials whose filter takes_net() and for coupled or sharpened colours. Reads levels from the cache
// (core/base/cache.h) or makes them. A damaged or foreign cache file is made anew. A cache that cannot be written gives a warning.
void keep_mips(Scene& scene, const Jobs& jobs);

} // namespace burnish
