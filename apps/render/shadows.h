// --shadows: adds ray-traced shadows of lights to a picture drawn without occlusion.
#pragma once
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

// Returns true if some light of the session casts shadows.
bool casts_shadows(const RenderOptions& options, const FrameDesc& desc, const Session& session);

// `lit` is the session's frame for `desc`, with layers. Renders three more frames: two by rays, the lights alone with and without
// occluders, and one by the session without these lights. Fails as Session::render() does.
Status add_shadows(const RenderOptions& options, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
