// --floor mirror: adds the scene's reflection to the floor of a picture.
#pragma once
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

// Renders one more frame, seen from below the floor, and adds it by Fresnel's reflectance of a polished dielectric. lit: the session's
// frame for `desc`, with triangle ids. Fails as Session::render() does.
Status add_reflection(const RenderOptions& options, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
