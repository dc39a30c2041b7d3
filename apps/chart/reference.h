// References as charts and the atlas have them: kept, so that each is made once.
#pragma once
#include <string>

#include "apps/cli/report.h"
#include "raster/session/session.h"

namespace burnish {

struct ReferenceHome {      // where they are kept
    bool use_cache = true;  // beside the cached environments, so that all charts of a view share them
    std::string folder;     // where there is no such cache; empty: nowhere
    double save_every = 10; // seconds, while one is made
};

// Of what `session` draws by `desc`. Goes on from what is kept; a kept file that is damaged is told and made anew. A frame whose
// stats.sampling.stopped is set is not finished: options.stop was.
Result<Frame> kept_reference(const Session& session, const FrameDesc& desc, ReferenceOptions options, Isa isa, const ReferenceHome& home,
                             Report& report);

} // namespace burnish
