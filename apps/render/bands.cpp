#include "apps/render/bands.h"

#include <algorithm>
#include <cstring>
#include <fmt/core.h>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/lab.h"
#include "apps/cli/outputs.h"
#include "apps/pieces/given.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "apps/render/picture.h"
#include "core/base/clock.h"
#include "core/base/hash.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_stream.h"
#include "core/jobs/jobs.h"
#include "raster/frame/upload.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

// The rows of a band, in each form that some output needs.
struct Band {
    Image linear;                   // f32, RGB or RGBA
    Image layered;                  // f32, with --aov
    std::vector<std::string> names; // of its channels
    Image shown;                    // u8, for .png
    FrameStats stats;
    std::uint64_t nan_pixels = 0;
};

struct Bands {
    const RenderOptions& options;
    FrameDesc desc; // of the first window
    Session& session;
    const RenderFigures& figures;
    bool margin = false; // pixels read their neighbours, so windows reach beyond the band

    int width() const { return picture_width(desc); }
    int height() const { return picture_height(desc); }
    int count() const { return (height() + options.band_rows - 1) / options.band_rows; }
    int rows(int band) const { return std::min(options.band_rows, height() - band * options.band_rows); }
    bool in_cells() const { return std::max(width(), height()) > kMaxPictureSide; }
};

bool has_margin(const RenderOptions& options, const FrameDesc& desc, const Session& session)
{
    const auto shares = [&](std::size_t material) { return (technique_of(desc, material).traits & kSharesSamples) != 0; };
    bool any = (technique_of(desc).traits & kSharesSamples) != 0;
    for (std::size_t i = 0; i < desc.by_material.size(); ++i)
        any = any || shares(i);
    return any || casts_shadows({options.shadows, options.shadow_samples, options.isa, true}, desc, session);
}

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

bool shows_some(const RenderOptions& options)
{
    return std::any_of(options.outputs.begin(), options.outputs.end(), is_png);
}

void add_stats(const FrameStats& from, FrameStats& to)
{
    to.triangles = from.triangles; // fragments of margins lie in several windows, so none are counted
    to.ms += from.ms;
}

Result<Band> draw_band(const Bands& bands, int index)
{
    Band band;
    RenderOptions options = bands.options;
    options.quiet = true; // of the windows
    const int top = index * bands.options.band_rows;
    const Side y = side_of(top, top + bands.rows(index), bands.height(), bands.margin);
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
        // Copy the band's part
        paste(rendered->color, x, y, bands.width(), left, band.linear);
        if (!options.aov.empty())
            paste(rendered->layered.image, x, y, bands.width(), left, band.layered), band.names = rendered->layered.names;
        if (shows_some(options))
            paste(display_picture(rendered->color, options.tonemap, options.exposure_ev, rendered->parts, options.resolve), x, y,
                  bands.width(), left, band.shown);
    }
    band.nan_pixels = count_not_finite(band.linear);
    return band;
}

// The hash of a picture, as pixel_hash(), from its bands.
class BandHash {
  public:
    BandHash(int width, int height)
    {
        const std::uint32_t header[3] = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 3};
        hash_ = HashStream(hash_bytes(header, sizeof header));
    }
    void add(const Image& band)
    {
        if (band.channels == 3)
            return hash_.add(band.bytes.data(), band.bytes.size());
        for (std::size_t i = 0; i < static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height); ++i)
            hash_.add(band.f32() + i * static_cast<std::size_t>(band.channels), 3 * sizeof(float));
    }
    std::uint64_t value() const { return hash_.value(); }

  private:
    HashStream hash_;
};

// The outputs of a picture, open from its first band on.
class BandFiles {
  public:
    BandFiles(const Bands& bands) : bands_(bands) {}
    Status add(const Band& band)
    {
        if (streams_.empty())
            BN_TRY(open(band));
        for (std::size_t i = 0; i < streams_.size(); ++i)
            BN_TRY(streams_[i]->add(rows_for(bands_.options.outputs[i], band)));
        return {};
    }
    Status finish(Report& report)
    {
        for (std::size_t i = 0; i < streams_.size(); ++i) {
            BN_TRY(streams_[i]->finish());
            report.wrote(bands_.options.outputs[i]);
        }
        return {};
    }

  private:
    const Image& rows_for(const std::string& path, const Band& band) const
    {
        return is_png(path) ? band.shown : band.layered.empty() ? band.linear : band.layered;
    }
    Status open(const Band& band)
    {
        for (const std::string& path : bands_.options.outputs) {
            StreamedPicture picture{bands_.width(), bands_.height(), rows_for(path, band).channels, {}, 0};
            if (!is_png(path))
                picture.channel_names = band.names, picture.tile = bands_.in_cells() ? kBandTile : 0;
            Result<std::unique_ptr<ImageStream>> stream = open_image_stream(path, picture);
            BN_TRY(stream);
            streams_.push_back(std::move(*stream));
        }
        return {};
    }

    const Bands& bands_;
    std::vector<std::unique_ptr<ImageStream>> streams_;
};

Json figures_of(const Image& image)
{
    return {image.width, image.height, image.channels, static_cast<int>(image.type)};
}

std::vector<std::uint8_t> packed_band(Band band)
{
    Packed packed;
    Json figures = {{"names", band.names}, {"nan_pixels", band.nan_pixels}, {"triangles", band.stats.triangles}, {"images", Json::array()}};
    for (Image* image : {&band.linear, &band.layered, &band.shown}) {
        figures["images"].push_back(figures_of(*image));
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(image->bytes.data());
        packed.files.push_back({std::to_string(packed.files.size()), {bytes, bytes + image->bytes.size()}});
        *image = {};
    }
    packed.json = figures.dump();
    return pack(packed);
}

// Reads a band that packed_band() packed. Pieces carry a hash, so what is read is what was written.
Result<Band> read_band(const std::string& file, const std::string& key)
{
    Result<std::vector<std::uint8_t>> content = read_piece(file, key);
    BN_TRY(content);
    Result<Packed> packed = unpack(*content, file);
    BN_TRY(packed);
    *content = {};
    const Error damaged = {ExitCode::bad_input, file, "", "is a damaged piece"};
    Band band;
    try {
        const Json figures = Json::parse(packed->json);
        band.names = figures.at("names").get<std::vector<std::string>>();
        band.nan_pixels = figures.at("nan_pixels").get<std::uint64_t>();
        band.stats.triangles = figures.at("triangles").get<std::uint64_t>();
        Image* const images[] = {&band.linear, &band.layered, &band.shown};
        for (std::size_t i = 0; i < std::size(images); ++i) {
            const auto shape = figures.at("images").at(i).get<std::vector<int>>();
            const std::vector<std::uint8_t> bytes = std::move(packed->files.at(i).bytes);
            if (bytes.empty())
                continue;
            *images[i] = make_image(shape.at(0), shape.at(1), shape.at(2), static_cast<PixelType>(shape.at(3)));
            if (images[i]->bytes.size() != bytes.size())
                return damaged;
            std::memcpy(images[i]->bytes.data(), bytes.data(), bytes.size());
        }
    } catch (const std::exception&) {
        return damaged;
    }
    return band;
}

std::vector<JobPiece> band_pieces(const Bands& bands, const OptionTable& given)
{
    const SessionParts& parts = bands.session.parts();
    const std::string text =
        fmt::format("{:016x} {:016x} {}{}", reference_key(parts.input(), bands.session.drawn(bands.desc), bands.options.reference),
                    parts.environment->content_hash, bands.options.band_rows,
                    text_of_scene(bands.options.scene, bands.session.scene().files) + text_of_given(given)) +
        (shows_some(bands.options) ? "\nshown" : "");
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a row
    std::vector<JobPiece> pieces;
    for (int i = 0; i < bands.count(); ++i) {
        const std::string key = piece_key(fmt::format("band {} {}", i, text));
        const auto seconds = [&bands, rate, i]() -> Result<double> {
            if (!*rate) {
                const int middle = bands.count() / 2;
                const double begin = wall_ms();
                BN_TRY(draw_band(bands, middle));
                *rate = (wall_ms() - begin) * 1e-3 / bands.rows(middle);
            }
            return **rate * bands.rows(i);
        };
        const auto make = [&bands, i, key](const std::string& file) -> Status {
            Result<Band> band = draw_band(bands, i);
            BN_TRY(band);
            return write_piece(file, key, packed_band(std::move(*band)));
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

void report_bands(const Bands& bands, const RenderFigures& figures, Report& report)
{
    const std::string ms = figures.frame.ms > 0.0 ? fmt::format(": {:.0f} ms", figures.frame.ms) : ""; // pieces keep no time
    report.event("frame", fmt::format("{}x{}, {} samples a pixel, {}, in {} bands{}", bands.width(), bands.height(), bands.desc.msaa,
                                      bands.desc.technique, bands.count(), ms));
    report.event("pixel hash:", hash_text(figures.hash));
}

// Takes band after band, and writes them.
int write_bands(const Bands& bands, const std::function<Result<Band>(int)>& band_at, RenderFigures figures, Report& report)
{
    BandFiles files(bands);
    BandHash hash(bands.width(), bands.height());
    Progress progress("bands", static_cast<std::size_t>(bands.count()), bands.options.quiet);
    for (int i = 0; i < bands.count(); ++i) {
        const Result<Band> band = band_at(i);
        if (!band)
            return fail(band.error());
        if (const Status added = files.add(*band); !added)
            return fail(added.error());
        hash.add(band->linear);
        add_stats(band->stats, figures.frame);
        figures.nan_pixels += band->nan_pixels;
        progress.step();
    }
    if (const Status finished = files.finish(report); !finished)
        return fail(finished.error());
    figures.hash = hash.value();
    figures.frame_ms = {figures.frame.ms};
    report_bands(bands, figures, report);
    figures.warnings = report.warnings();
    if (!bands.options.stats_file.empty()) {
        const Status written = write_text(bands.options.stats_file, json_text(stats_json(bands.options, figures), 2) + "\n");
        if (!written)
            return fail(written.error());
        report.wrote(bands.options.stats_file);
    }
    if (!bands.options.trace_file.empty()) {
        if (const Status written = write_text(bands.options.trace_file, Trace::json()); !written)
            return fail(written.error());
        report.wrote(bands.options.trace_file);
    }
    if (figures.nan_pixels)
        return fail(Error{ExitCode::not_finite, bands.options.scene, "",
                          fmt::format("{} of {} pixels are NaN or Inf", figures.nan_pixels, std::int64_t{bands.width()} * bands.height())});
    return 0;
}

} // namespace

int run_bands(const RenderArguments& arguments, const OptionTable& given, const RenderOptions& options, const FrameDesc& desc,
              Session& session, RenderFigures figures, Report& report)
{
    const Bands bands{options, desc, session, figures, has_margin(options, desc, session)};
    if (!any_pieces(arguments.pieces)) {
        report.release();
        return write_bands(
            bands, [&](int i) { return draw_band(bands, i); }, figures, report);
    }
    const std::vector<JobPiece> pieces = band_pieces(bands, given);
    if (!arguments.pieces.merge)
        return run_pieces(arguments.pieces, kept_words(), pieces, report);
    const auto files = finished_pieces(arguments.pieces, kept_words(), pieces);
    if (!files)
        return fail(files.error());
    report.release();
    const auto read = [&](int i) { return read_band((*files)[static_cast<std::size_t>(i)], pieces[static_cast<std::size_t>(i)].key); };
    return write_bands(bands, read, figures, report);
}

} // namespace burnish
