// References for charts and the atlas, cached on disk and made once.
#pragma once
#include <string>

#include "apps/cli/report.h"
#include "raster/session/session.h"

namespace burnish {

struct ReferenceCache {     // where references are cached
    bool use_cache = true;  // beside the cached environments, shared by all charts of a view
    std::string folder;     // fallback without that cache; empty: nowhere
    double save_every = 10; // seconds between saves
};

// Returns `options` with checkpoint files in `home`.
ReferenceOptions cached_reference_options(ReferenceOptions options, const ReferenceCache& home, Report& report);

// Returns the reference's frame for `desc`, resumed from its file. `options` are the session's options, from cached_reference_options().
// Reports a damaged file and renders anew. If stats.sampling.stopped is set, options.stop ended the frame early and the frame is
// incomplete.
Result<Frame> cached_reference(Session& reference, const FrameDesc& desc, const ReferenceOptions& options, Report& report);

// As above, for the picture that a session of the tile renderer draws.
Result<Frame> cached_reference(const Session& session, const FrameDesc& desc, const ReferenceOptions& options, Isa isa,
                               const ReferenceCache& home, Report& report);

} // namespace burnish
