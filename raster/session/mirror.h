// The scene's reflection in a polished floor (FloorKind::mirror), added to a picture.
#pragma once
#include "raster/session/shadows.h"

namespace burnish {

// Renders one more frame, seen from below the floor, and adds it by Fresnel's reflectance of a polished dielectric. shadows: that the
// reflected scene has. lit: the session's frame for `desc`, with triangle ids, after its shadows. Errors: Session::render()'s; usage
// where `lit` is another frame or has no triangle ids. Scenes without a floor keep their picture.
Status add_reflection(const ShadowSettings& shadows, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
