// Levels of nets and of searches, and of colours that are no plain means, on disk, found by what they are made of: they take seconds to
// minutes to make.
#pragma once
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

// Makes mips.cached of materials whose filter takes_net(), and of coupled or sharper colours, or finds them in the cache
// (core/base/cache.h). A file there that is damaged, or of anything else, is made anew; a cache that cannot be written is a warning.
void keep_mips(Scene& scene, SceneMips& mips, const Jobs& jobs);

} // namespace burnish
