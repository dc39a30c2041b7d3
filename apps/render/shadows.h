// --shadows ratio: adds ray-traced shadows of area lights to a picture drawn without occlusion.
#pragma once
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

// `lit` is the session's frame for `desc`, with layers. Renders three more frames: two by the reference, area lights alone with and
// without
// occluders, and one by the session without area lights. Fails as Session::render() does.
Status add_shadows(const RenderOptions& options, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
