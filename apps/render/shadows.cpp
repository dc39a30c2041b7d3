#include "apps/render/shadows.h"

#include <utility>

#include "raster/frame/shadow_ratio.h"
#include "shading/lang/records.h"

namespace burnish {

Status add_shadows(const RenderOptions& options, const FrameDesc& desc, Session& session, Frame& lit)
{
    FrameDesc plain = desc; // only the colour is needed
    plain.layers = plain.parts = plain.triangle_ids = false;
    Image light[2];
    for (const bool open : {false, true}) {
        const TraceSpan span(open ? "area lights without shadows" : "area lights with shadows");
        SessionOptions reference;
        reference.backend = Backend::reference, reference.isa = reference.reference.isa = options.isa;
        reference.reference.mode = open ? ReferenceMode::direct : ReferenceMode::shadowed;
        reference.reference.samples = static_cast<std::uint64_t>(options.shadow_samples);
        reference.reference.area_lights_only = true;
        reference.reference.quiet = options.quiet;
        Result<Session> rays = Session::make(session.parts(), reference);
        BN_TRY(rays);
        Result<Frame> frame = rays->render(plain);
        BN_TRY(frame);
        light[open] = std::move(frame->color);
    }
    FrameDesc without = plain;
    without.area_way = kAreaWay_off;
    Result<Frame> unlit = session.render(without);
    BN_TRY(unlit);
    const TraceSpan span("shadows");
    // Layers are in world space, and so is this view.
    lit.color = with_shadows(lit.color, unlit->color, shadow_ratio(light[0], light[1], lit.layers, desc.view, *session.parts().jobs));
    return {};
}

} // namespace burnish
