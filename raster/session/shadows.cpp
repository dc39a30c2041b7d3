#include "raster/session/shadows.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "core/jobs/jobs.h"
#include "raster/frame/shadow_ratio.h"
#include "raster/session/check_parts.h"
#include "raster/session/guarded.h"
#include "raster/session/session.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

enum class Lights { area, lamps }; // lamps: punctual and extracted lights

bool shade(Lights kind, const ShadowSettings& settings, const FrameDesc& desc, const Session& session)
{
    if (kind == Lights::area)
        return settings.of != Shadows::off && desc.area_way != kAreaWay_off && !session.tables().area_lights.empty();
    return settings.of == Shadows::on && (!session.tables().lights.empty() || !session.parts().environment->extracted_lights.empty());
}

// Traces the light of one kind, with and without occluders, and returns the ratio.
Result<Image> traced_ratio(Lights kind, const ShadowSettings& settings, const FrameDesc& desc, const Session& session, const Frame& lit)
{
    Image light[2];
    for (const bool open : {false, true}) {
        const TraceSpan span(open ? "lights without shadows" : "lights with shadows");
        SessionOptions rays;
        rays.backend = Backend::reference, rays.isa = settings.isa;
        rays.reference.mode = open ? ReferenceMode::direct : ReferenceMode::shadowed;
        rays.reference.own_rays = true, rays.reference.shades = 1;
        rays.reference.samples = static_cast<std::uint64_t>(settings.samples);
        (kind == Lights::area ? rays.reference.area_lights_only : rays.reference.lamps_only) = true;
        rays.reference.quiet = settings.quiet;
        Result<Session> traced = Session::make(session.parts(), rays);
        BN_TRY(traced);
        Result<Frame> frame = traced->render(desc);
        BN_TRY(frame);
        light[open] = std::move(frame->color);
    }
    // Layers are in world space, and so is this view. Points of lamps are not chosen at random.
    return shadow_ratio(light[0], light[1], lit.layers, desc, *session.parts().jobs, kind == Lights::area);
}

Status darken_by_rays(const ShadowSettings& settings, const FrameDesc& desc, Session& session, Frame& lit)
{
    FrameDesc plain = desc; // only the colour is needed
    plain.layers = plain.triangle_ids = plain.parts = false;
    const Image open = lit.color;
    const std::vector<PixelPart> open_parts = lit.parts;
    for (const Lights kind : {Lights::area, Lights::lamps}) {
        if (!shade(kind, settings, desc, session))
            continue;
        const Result<Image> ratio = traced_ratio(kind, settings, plain, session, lit);
        BN_TRY(ratio);
        FrameDesc without = plain;
        without.parts = desc.parts;
        if (kind == Lights::area)
            without.area_way = kAreaWay_off;
        else
            without.lamps = false;
        Result<Frame> unlit = session.render(without);
        BN_TRY(unlit);
        if (unlit->parts.size() != lit.parts.size())
            return Error{ExitCode::usage, "", "/parts", "are those of another picture"};
        const TraceSpan span("shadows");
        darken(lit.color, open, unlit->color, *ratio);
        darken(lit.parts, open_parts, unlit->parts, *ratio);
    }
    return {};
}

} // namespace

bool casts_shadows(const ShadowSettings& settings, const FrameDesc& desc, const Session& session)
{
    if (!session.parts().scene)
        return false;
    return shade(Lights::area, settings, desc, session) || shade(Lights::lamps, settings, desc, session);
}

Status check_shadows(const ShadowSettings& settings)
{
    constexpr int kMostSamples = 1 << 20;
    if (settings.of != Shadows::off && settings.of != Shadows::ratio && settings.of != Shadows::on)
        return Error{ExitCode::usage, "", "", fmt::format("{} names no shadows", static_cast<int>(settings.of)), "ShadowSettings::of"};
    if (settings.samples < 1 || settings.samples > kMostSamples)
        return Error{ExitCode::usage, "", "", fmt::format("{} samples; 1 to {}", settings.samples, kMostSamples),
                     "ShadowSettings::samples"};
    return {};
}

Status check_drawn(const Frame& lit, const FrameDesc& desc)
{
    if (lit.color.width != desc.width || lit.color.height != desc.height || lit.color.channels != 3 || lit.color.type != PixelType::f32)
        return Error{ExitCode::usage, "", "/color",
                     fmt::format("is no picture of {}x{} pixels, as FrameDesc says", desc.width, desc.height)};
    const std::int64_t pixels = std::int64_t{desc.width} * desc.height;
    for (const PixelPart& part : lit.parts)
        if (part.pixel >= pixels || part.first >= desc.msaa)
            return Error{ExitCode::usage, "", "/parts", "are those of another picture"};
    return {};
}

Status add_shadows(const ShadowSettings& settings, const FrameDesc& desc, Session& session, Frame& lit)
{
    if (!session.parts().scene)
        return moved_away();
    return guarded(session.parts().scene->name, [&]() -> Status {
        BN_TRY(check_shadows(settings));
        BN_TRY(check_drawn(lit, desc));
        if (!casts_shadows(settings, desc, session))
            return {};
        if (lit.layers.size() != static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height))
            return Error{ExitCode::usage, "", "/layers", "are missing: draw with FrameDesc::layers"};
        return darken_by_rays(settings, desc, session, lit);
    });
}

} // namespace burnish
