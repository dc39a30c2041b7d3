// Ray-traced shadows of lights, added to a picture drawn without occlusion.
#pragma once
#include "core/simd/dispatch.h"
#include "raster/frame/frame.h"

namespace burnish {

class Session;

enum class Shadows { off, ratio, on }; // ratio: of area lights; on: of punctual and extracted lights too

struct ShadowSettings {
    Shadows of = Shadows::off;
    int samples = 16; // a pixel, rounded up to steps of 16
    Isa isa = best_isa();
    bool quiet = true; // false: rays print their progress
};

// Returns true if some light of the session casts shadows.
bool casts_shadows(const ShadowSettings& settings, const FrameDesc& desc, const Session& session);

// Returns an error unless the settings are in their ranges, or `lit` is a picture of the description's size.
Status check_shadows(const ShadowSettings& settings);
Status check_drawn(const Frame& lit, const FrameDesc& desc);

// Darkens `lit`, the session's frame for `desc`, with FrameDesc::layers. Renders three more frames for each kind of light: two by rays,
// with and without occluders, and one by the session without these lights. Errors: Session::render()'s; usage where `lit` is another
// frame or has no layers.
Status add_shadows(const ShadowSettings& settings, const FrameDesc& desc, Session& session, Frame& lit);

} // namespace burnish
