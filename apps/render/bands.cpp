#include "apps/render/bands.h"

#include <cstring>
#include <fmt/core.h>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/words.h"
#include "apps/pieces/given.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "apps/render/picture.h"
#include "apps/render/rows.h"
#include "core/base/clock.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_stream.h"
#include "core/jobs/jobs.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

// Errors of a scene that is drawn as a whole are at the option that asks for bands.
Result<DrawnBand> draw_band(const Bands& bands, const RenderArguments& arguments, int index)
{
    Result<DrawnBand> band = draw_rows(bands, index * bands.options.band_rows, bands.rows(index));
    if (!band && band.error().field == "FrameDesc::window")
        return no_bands_error(arguments, "cannot be combined with this scene: " + band.error().reason);
    return band;
}

// The outputs of a picture, open from its first band on.
class BandFiles {
  public:
    BandFiles(const Bands& bands) : bands_(bands) {}
    Status add(const DrawnBand& band)
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
    const Image& rows_for(const std::string& path, const DrawnBand& band) const
    {
        return is_png(path) ? band.shown : band.layered.empty() ? band.linear : band.layered;
    }
    Status open(const DrawnBand& band)
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

std::vector<std::uint8_t> packed_band(DrawnBand band)
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
Result<DrawnBand> read_band(const std::string& file, const std::string& key)
{
    Result<std::vector<std::uint8_t>> content = read_piece(file, key);
    BN_TRY(content);
    Result<Packed> packed = unpack(*content, file);
    BN_TRY(packed);
    *content = {};
    const Error damaged = {ExitCode::bad_input, file, "", "is a damaged piece"};
    DrawnBand band;
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

std::vector<JobPiece> band_pieces(const Bands& bands, const RenderArguments& arguments, const OptionTable& given)
{
    const SessionParts& parts = bands.session.parts();
    const std::string text =
        fmt::format("{:016x} {:016x} {}{}", reference_key(parts.input(), bands.session.drawn(bands.desc), bands.options.reference),
                    parts.environment->content_hash, bands.options.band_rows,
                    text_of_scene(bands.options.scene, bands.session.scene().files) + text_of_given(given)) +
        (writes_png(bands.options) ? "\nshown" : "");
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a row
    std::vector<JobPiece> pieces;
    for (int i = 0; i < bands.count(); ++i) {
        const std::string key = piece_key(fmt::format("band {} {}", i, text));
        const auto seconds = [&bands, &arguments, rate, i]() -> Result<double> {
            if (!*rate) {
                const int middle = bands.count() / 2;
                const double begin = wall_ms();
                BN_TRY(draw_band(bands, arguments, middle));
                *rate = (wall_ms() - begin) * 1e-3 / bands.rows(middle);
            }
            return **rate * bands.rows(i);
        };
        const auto make = [&bands, &arguments, i, key](const std::string& file) -> Status {
            Result<DrawnBand> band = draw_band(bands, arguments, i);
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
int write_bands(const Bands& bands, const std::function<Result<DrawnBand>(int)>& band_at, RenderFigures figures, Report& report)
{
    BandFiles files(bands);
    BandHash hash(bands.width(), bands.height());
    Progress progress("bands", static_cast<std::size_t>(bands.count()), bands.options.quiet);
    for (int i = 0; i < bands.count(); ++i) {
        const Result<DrawnBand> band = band_at(i);
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
            bands, [&](int i) { return draw_band(bands, arguments, i); }, figures, report);
    }
    const std::vector<JobPiece> pieces = band_pieces(bands, arguments, given);
    if (!arguments.pieces.merge)
        return run_pieces(arguments.pieces, command_words(), pieces, report);
    const auto files = finished_pieces(arguments.pieces, command_words(), pieces);
    if (!files)
        return fail(files.error());
    report.release();
    const auto read = [&](int i) { return read_band((*files)[static_cast<std::size_t>(i)], pieces[static_cast<std::size_t>(i)].key); };
    return write_bands(bands, read, figures, report);
}

} // namespace burnish
