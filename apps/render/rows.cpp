#include "apps/render/rows.h"

#include <algorithm>
#include <cstring>

#include "apps/cli/outputs.h"
#include "apps/render/picture.h"
#include "core/image/io/image_io.h"
#include "core/jobs/jobs.h"
#include "raster/frame/upload.h"

namespace burnish {
namespace {

// One direction of a window and of the part of it that a band takes.
struct Side {
    int first, size; // of the window in the picture
    int skip, taken; // of the window
};
Side side_of(int begin, int end, int picture, bool margin)
{
    const int before = margin && begin > 0 ? kWindowStep : 0, after = margin ? std::min(kWindowStep, picture - end) : 0;
    return {begin - before, end - begin + before + after, before, end - begin};
}

// Copies a part of a window into the band, which is made where it is empty. left: the part's first column in the band.
void paste(const Image& window, const Side& x, const Side& y, int width, int left, Image& band)
{
    if (band.empty())
        band = make_image(width, y.taken, window.channels, window.type);
    const std::size_t pixel = static_cast<std::size_t>(window.channels) * pixel_type_bytes(window.type);
    for (int row = 0; row < y.taken; ++row) {
        const std::size_t from =
            static_cast<std::size_t>(y.skip + row) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(x.skip);
        const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(left);
        std::memcpy(band.bytes.data() + to * pixel, window.bytes.data() + from * pixel, static_cast<std::size_t>(x.taken) * pixel);
    }
}

} // namespace

bool writes_png(const RenderOptions& options)
{
    return std::any_of(options.outputs.begin(), options.outputs.end(), is_png);
}

bool has_margin(const RenderOptions& options, const FrameDesc& desc, const Session& session)
{
    const auto shares = [&](std::size_t material) { return (technique_of(desc, material).traits & kSharesSamples) != 0; };
    bool any = (technique_of(desc).traits & kSharesSamples) != 0;
    for (std::size_t i = 0; i < desc.by_material.size(); ++i)
        any = any || shares(i);
    return any || casts_shadows({options.shadows, options.shadow_samples, options.isa, true}, desc, session);
}

void add_stats(const FrameStats& from, FrameStats& to)
{
    to.triangles = from.triangles; // fragments of margins lie in several windows, so none are counted
    to.ms += from.ms;
}

Result<DrawnBand> draw_rows(const Bands& bands, int top, int rows)
{
    DrawnBand band;
    RenderOptions options = bands.options;
    options.quiet = true; // of the windows
    const Side y = side_of(top, top + rows, bands.height(), bands.margin);
    const int step = bands.in_cells() ? kWindowCell : bands.width();
    for (int left = 0; left < bands.width(); left += step) {
        // Draw a window
        const Side x = side_of(left, std::min(left + step, bands.width()), bands.width(), bands.margin);
        FrameDesc desc = bands.desc;
        desc.window.left = x.first, desc.window.top = y.first, desc.width = x.size, desc.height = y.size;
        const TraceSpan span("band");
        const Result<Rendered> rendered = render_frames(options, desc, bands.session, bands.figures);
        BN_TRY(rendered);
        add_stats(rendered->figures.frame, band.stats);
        for (std::size_t i = 0; i < kFrameStages; ++i)
            band.stage_ns[i] += rendered->profile.stage_ns[i];
        // Copy the band's part
        paste(rendered->color, x, y, bands.width(), left, band.linear);
        if (!options.aov.empty())
            paste(rendered->layered.image, x, y, bands.width(), left, band.layered), band.names = rendered->layered.names;
        if (writes_png(options))
            paste(display_picture(rendered->color, options.tonemap, options.exposure_ev, rendered->parts, options.resolve,
                                  bands.session.parts().jobs.get()),
                  x, y, bands.width(), left, band.shown);
    }
    band.nan_pixels = count_not_finite(band.linear);
    return band;
}

BandHash::BandHash(int width, int height)
{
    const std::uint32_t header[3] = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 3};
    hash_ = HashStream(hash_bytes(header, sizeof header));
}

void BandHash::add(const Image& band)
{
    if (band.channels == 3)
        return hash_.add(band.bytes.data(), band.bytes.size());
    for (std::size_t i = 0; i < static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height); ++i)
        hash_.add(band.f32() + i * static_cast<std::size_t>(band.channels), 3 * sizeof(float));
}

} // namespace burnish
