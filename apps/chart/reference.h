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

// With files of their own there, or nowhere.
ReferenceOptions kept_options(ReferenceOptions options, const ReferenceHome& home, Report& report);

// Of what `reference` draws by `desc`, with `options`, kept_options(), as it was made. Goes on from what is kept; a kept file that is
// damaged is told and made anew. A frame whose stats.sampling.stopped is set is not finished: options.stop was.
Result<Frame> kept_reference(Session& reference, const FrameDesc& desc, const ReferenceOptions& options, Report& report);

// The same of what a session of the tile renderer draws.
Result<Frame> kept_reference(const Session& session, const FrameDesc& desc, const ReferenceOptions& options, Isa isa,
                             const ReferenceHome& home, Report& report);

} // namespace burnish
