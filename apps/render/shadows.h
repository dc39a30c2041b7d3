// --shadows ratio: shadows of area lights on a picture that a technique drew without anything in their way.
#pragma once
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

// lit: drawn by the session as `desc` says, with its layers. By two more frames of the reference, which see area lights alone with and
// without what is in their way, and one of the session without those. Errors as Session::render().
Status add_shadows(const RenderOptions& options, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
