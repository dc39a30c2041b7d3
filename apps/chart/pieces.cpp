// A chart in pieces: a place each.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/core.h>

#include "apps/chart/chart.h"
#include "apps/options/parameters.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "raster/reference/sobol.h"

namespace burnish {

namespace fs = std::filesystem;

// Returns the key of a place's piece: without machine and threads, which change times alone.
std::string Chart::key_of_piece(const Place& place) const
{
    const FrameDesc& timed = options_.base.frame;
    std::string text =
        fmt::format("chart {:016x} {} {} {}x{} {} {} {} {} {} {} {} {} {}", place.key, place.tile.parts().environment->content_hash,
                    options_.reference_samples, timed.width, timed.height, timed.msaa, timed.tile_size, parameters_text(place.desc),
                    describe(place.cell), options_.runs, picture_width_, options_.base.exposure_ev, static_cast<int>(options_.base.tonemap),
                    options_.display_flip ? 1 + static_cast<int>(options_.base.resolve) : 0);
    for (const Setting& setting : settings_)
        text += fmt::format(" {} {}", setting.technique, setting.samples);
    return piece_key(text);
}

// Estimates from a small reference, and one frame.
Result<double> Chart::seconds_of_piece(const Spot& spot)
{
    double seconds = 0.0;
    const Status measured = at_place(spot, [&](const Place& place) -> Status {
        constexpr int kProbeWidth = 64;
        SessionOptions of_reference;
        of_reference.backend = Backend::reference, of_reference.isa = options_.base.isa, of_reference.reference.samples = kPassSamples;
        Result<Session> reference = Session::make(place.tile.parts(), of_reference);
        BN_TRY(reference);
        FrameDesc small = place.desc;
        small.width = std::min(kProbeWidth, small.width), small.height = std::max(1, small.width * place.desc.height / place.desc.width);
        const double begin = wall_ms();
        BN_TRY(reference->render(small));
        const double middle = wall_ms();
        BN_TRY(place.tile.render(timed_desc_of(place, settings_.front())));
        const double samples = static_cast<double>(options_.reference_samples) / kPassSamples;
        const double pixels = static_cast<double>(place.desc.width) * place.desc.height / (static_cast<double>(small.width) * small.height);
        seconds = 1e-3 * ((middle - begin) * samples * pixels +
                          (wall_ms() - middle) * static_cast<double>(settings_.size()) * (options_.runs + 2));
        return {};
    });
    BN_TRY(measured);
    return seconds;
}

// Measures a place into a piece, by way of a folder beside it. The reference of a killed process is cached.
Status Chart::write_piece_of(const Spot& spot, const std::string& file, const std::string& key)
{
    const std::string folder = own_name_beside(file, ".part");
    Result<ChartCheckpoint> own = ChartCheckpoint::open(folder, report_);
    BN_TRY(own);
    ChartCheckpoint* const whole = std::exchange(checkpoint_, &*own);
    progress_ = std::make_unique<Progress>("chart", settings_.size() * static_cast<std::size_t>(options_.runs + 1), options_.base.quiet);
    Packed packed;
    const Status made = at_place(spot, [&](const Place& place) -> Status {
        BN_TRY(measure_place(place));
        BN_TRY(checkpoint_->save());
        if (stopped())
            return {};
        ChartResults results;
        results.references["reference"] = checkpoint_->references().at(reference_name(place));
        results.others = load_.others();
        std::vector<std::string> pictures = {reference_picture(place)};
        for (std::size_t i = 0; i < settings_.size(); ++i) {
            const ChartRow row = new_row(place, settings_[i]);
            results.rows[std::to_string(i)] = row.measured;
            pictures.insert(pictures.end(), {row.picture, row.error_map});
        }
        for (const std::string& picture : pictures) {
            Result<std::vector<std::uint8_t>> bytes = read_file(picture, std::uint64_t{1} << 30);
            BN_TRY(bytes);
            packed.files.push_back({"", std::move(*bytes)});
        }
        packed.json = chart_results_json(results);
        const ChartMachine& m = out_.machine;
        packed.files.push_back({fmt::format("{}\n{}\n{}", m.processor, m.isa, m.threads), {}});
        return {};
    });
    checkpoint_ = whole;
    progress_.reset();
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    BN_TRY(made);
    return stopped() ? Status() : write_piece(file, key, pack(packed));
}

// Takes over a piece's figures and pictures.
Status Chart::take_piece(const Place& place, const Packed& packed, const std::string& file)
{
    const Error damaged = {ExitCode::bad_input, file, "", "is a damaged piece"};
    Result<ChartResults> results = parse_chart_results(packed.json, file);
    BN_TRY(results);
    if (packed.files.size() != 2 * settings_.size() + 2 || !results->references.count("reference"))
        return damaged;
    checkpoint_->references()[reference_name(place)] = results->references.at("reference");
    if (results->others)
        checkpoint_->others() = std::max(*results->others, checkpoint_->others().value_or(0.0));
    std::vector<std::string> pictures = {reference_picture(place)};
    for (std::size_t i = 0; i < settings_.size(); ++i) {
        const auto row_at = results->rows.find(std::to_string(i));
        if (row_at == results->rows.end())
            return damaged;
        const ChartRow row = new_row(place, settings_[i]);
        checkpoint_->row(row.key) = row_at->second;
        pictures.insert(pictures.end(), {row.picture, row.error_map});
    }
    for (std::size_t i = 0; i < pictures.size(); ++i)
        BN_TRY(write_file_atomic(pictures[i], packed.files[i].bytes.data(), packed.files[i].bytes.size()));
    machines_.insert(packed.files.back().name);
    return {};
}

Result<std::vector<JobPiece>> Chart::pieces()
{
    std::vector<JobPiece> all;
    for (const Spot& spot : spots()) {
        std::string key;
        BN_TRY(at_place(spot, [&](const Place& place) -> Status {
            key = key_of_piece(place);
            return {};
        }));
        all.push_back({key, [this, spot] { return seconds_of_piece(spot); },
                       [this, spot, key](const std::string& file) { return write_piece_of(spot, file, key); }});
    }
    return all;
}

Status Chart::take(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    const std::vector<Spot> all = spots();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        const Result<Packed> packed = unpack(*content, files[i]);
        BN_TRY(packed);
        BN_TRY(at_place(all[i], [&](const Place& place) { return take_piece(place, *packed, files[i]); }));
    }
    // Name the machine, or tell that there were several
    std::string text = machines_.size() == 1 ? *machines_.begin() : fmt::format("{} machines\nseveral\n0", machines_.size());
    if (options_.runs > 0) {
        out_.machine.processor = text.substr(0, text.find('\n'));
        text.erase(0, text.find('\n') + 1);
        out_.machine.isa = text.substr(0, text.find('\n'));
        out_.machine.threads = std::atoi(text.c_str() + text.find('\n') + 1);
    }
    return {};
}

} // namespace burnish
