// --floor mirror: adds the scene's reflection to the floor of a picture.
#pragma once
#include "raster/session/session.h"

namespace burnish {

// `lit` is the session's frame for `desc`, with triangle ids. Renders one more frame, seen from below the floor, and adds it by Fresnel's
// reflectance of a polished dielectric. Fails as Session::render() does.
Status add_reflection(const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
