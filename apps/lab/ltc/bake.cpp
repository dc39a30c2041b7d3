#include "apps/lab/ltc/bake.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/words.h"
#include "apps/lab/ltc/preview.h"
#include "apps/lab/ltc/report.h"
#include "apps/lab/ltc/resolutions.h"
#include "apps/report/chart_style.h"
#include "apps/report/svg.h"
#include "core/base/bytes.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "shading/lab/ltc/bake_ltc.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Returns true for the reference fit: each node fitted independently, as other LTC implementations do.
bool others_path(const LtcArguments& a)
{
    return a.norm != LtcNorm::l1 || a.interpolate != "mirror" || a.unaligned || a.unsymmetric;
}

ltc::Norm norm_of(const LtcArguments& a)
{
    switch (a.norm) {
    case LtcNorm::l3:
        return ltc::Norm::l3;
    case LtcNorm::sliced:
        return ltc::Norm::sliced;
    case LtcNorm::l1:
        break;
    }
    return ltc::Norm::l1;
}

// Returns the model with this lobe, or none if --brdf names a lobe without an LTC fit.
std::optional<ltc::Model> model_of(int brdf)
{
    const auto* const found = std::find(std::begin(ltc::kModelNames), std::end(ltc::kModelNames), std::string_view(lobe_model(brdf).name));
    if (found == std::end(ltc::kModelNames))
        return std::nullopt;
    return static_cast<ltc::Model>(found - std::begin(ltc::kModelNames));
}

Status check_arguments(const LtcBake& b, const OptionTable& given)
{
    const LtcArguments& a = b.options;
    if (!b.picture.empty())
        return usage_error("PICTURE", fmt::format("'{}': a table is made of nothing", b.picture));
    if (a.table.empty() == b.output.empty())
        return usage_error("-o", "is needed, or --table, and not both");
    if (!a.table.empty())
        for (const char* option :
             {"--steps", "--samples", "--half", "--isotropic", "--fit", "--interpolate", "--no-align", "--no-symmetry", "--brdf"})
            if (given.given(option))
                return usage_error(option, "says how a table is made, and --table FILE is made already");
    if (!model_of(b.brdf))
        return usage_error(
            "--brdf", fmt::format("'{}': only ggx_aniso, beckmann, ashikhmin_shirley and ward can be fitted", lobe_model(b.brdf).name));
    if (given.given("--lobes") && a.report.empty())
        return usage_error("--lobes", "says what --report FOLDER measures, which is not asked for");
    if (others_path(a) && given.given("--steps") && a.steps > 0)
        return usage_error(
            "--steps", "is of the fit between nodes, which needs --fit l1, --interpolate mirror, and aligned entries with their symmetry");
    if (!a.table.empty() && any_pieces(b.pieces))
        return usage_error("--table", "is made already, and has no pieces");
    if (a.isotropic)
        for (const char* option : {"--steps", "--samples", "--interpolate", "--no-align", "--no-symmetry"})
            if (given.given(option))
                return usage_error(option, "is of tables of all lobes, and this one is of --isotropic");
    if (!a.isotropic && a.table.empty() && a.resolution > 16)
        return usage_error("--resolution", fmt::format("{} is more than 16, which only a table of --isotropic may have", a.resolution));
    if (!a.report.empty())
        BN_TRY(check_folder_path(a.report));
    if (b.output == "-")
        return usage_error("-o", "the table is no text for standard output");
    if (b.output.empty())
        return {};
    BN_TRY(check_text_path("-o", b.output, {}));
    return check_text_path("-o", b.output + ".part", {});
}

Status write_report_files(const std::string& folder, const Json& figures, const std::vector<std::pair<std::string, Drawing>>& drawings,
                          Report& report)
{
    BN_TRY(make_output_folder(folder));
    std::vector<std::pair<std::string, std::string>> files = {{"quality.json", json_text(figures, 2) + "\n"}};
    for (const auto& [name, drawing] : drawings)
        files.emplace_back(name + ".svg", svg_of(drawing, chart_style()));
    for (const auto& [name, bytes] : files) {
        const std::string path = (fs::path(folder) / name).string();
        BN_TRY(write_file_atomic(path, bytes.data(), bytes.size()));
        report.wrote(path);
    }
    return {};
}

ltc::BakeOptions bake_options(const LtcArguments& a, int brdf, const OptionTable& given)
{
    ltc::BakeOptions options;
    options.grid = a.isotropic ? ltc::round_grid() : ltc::grid_of(a.resolution);
    if (given.given("--resolution"))
        options.grid.size = a.resolution;
    options.steps = a.isotropic || others_path(a) ? 0 : a.steps, options.samples_a_cell = a.samples;
    options.model = *model_of(brdf), options.norm = norm_of(a), options.align = !a.unaligned, options.symmetry = !a.unsymmetric;
    if (a.interpolate != "mirror") {
        options.grid.beyond = 0, options.grid.root_alpha = options.grid.over_alpha = false;
        options.grid.basis = ltc::Basis::tangent, options.grid.inverse = a.interpolate == "inverse";
    }
    options.stop = &watch_stop_signals();
    return options;
}

// A piece holds some chains of nodes: for each the number of nodes, then entries and L1 of each node.
constexpr std::size_t kChainsOfPiece = 16;

std::vector<std::uint8_t> chain_bytes(const std::vector<ltc::Chain>& chains)
{
    std::vector<std::uint8_t> bytes;
    for (const ltc::Chain& chain : chains) {
        const std::uint64_t count = chain.entries.size();
        append_bytes(bytes, &count, sizeof count);
        append_bytes(bytes, chain.entries.data(), count * sizeof(ltc::Matrix));
        append_bytes(bytes, chain.l1.data(), count * sizeof(double));
    }
    return bytes;
}

Result<std::vector<ltc::Chain>> chains_of_bytes(const std::vector<std::uint8_t>& bytes, std::size_t count, int nodes,
                                                const std::string& file)
{
    std::vector<ltc::Chain> chains(count);
    std::size_t at = 0;
    const auto take = [&](void* to, std::size_t size) {
        if (size > bytes.size() - at)
            return false;
        std::memcpy(to, bytes.data() + at, size);
        at += size;
        return true;
    };
    for (ltc::Chain& chain : chains) {
        std::uint64_t size = 0;
        const bool known = take(&size, sizeof size) && (size == 0 || size == static_cast<std::uint64_t>(nodes));
        chain.entries.resize(known ? size : 0), chain.l1.resize(known ? size : 0);
        if (!known || !take(chain.entries.data(), size * sizeof(ltc::Matrix)) || !take(chain.l1.data(), size * sizeof(double)))
            return Error{ExitCode::bad_input, file, "", "is a damaged piece"};
    }
    return chains;
}

std::vector<JobPiece> chain_pieces(const ltc::BakeOptions& options, const Jobs& jobs)
{
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a chain
    std::vector<JobPiece> pieces;
    for (std::size_t first = 0; first < ltc::bake_chains(options); first += kChainsOfPiece) {
        const std::size_t count = std::min(kChainsOfPiece, ltc::bake_chains(options) - first);
        const std::string key = piece_key(fmt::format("ltc {:016x} {} {}", ltc::bake_key(options), first, count));
        const auto seconds = [&options, &jobs, rate, count]() -> Result<double> {
            if (!*rate) {
                const double begin = wall_ms();
                ltc::fit_chains(options, 0, std::min<std::size_t>(kChainsOfPiece, ltc::bake_chains(options)), jobs);
                *rate = (wall_ms() - begin) * 1e-3 / kChainsOfPiece;
            }
            return **rate * static_cast<double>(count);
        };
        const auto make = [&options, &jobs, first, count, key](const std::string& file) -> Status {
            const std::vector<ltc::Chain> chains = ltc::fit_chains(options, first, count, jobs);
            return options.stop->load() ? Status() : write_piece(file, key, chain_bytes(chains));
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

Status take_chains(ltc::BakeOptions& options, const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        const std::size_t count = std::min(kChainsOfPiece, ltc::bake_chains(options) - i * kChainsOfPiece);
        Result<std::vector<ltc::Chain>> chains = chains_of_bytes(*content, count, options.grid.size, files[i]);
        BN_TRY(chains);
        std::move(chains->begin(), chains->end(), std::back_inserter(options.fitted));
    }
    return {};
}

// Lists or makes pieces of the table's fits. Returns the exit code.
int make_pieces(const LtcBake& b, const OptionTable& given, const Jobs& jobs, Report& report)
{
    const ltc::BakeOptions options = bake_options(b.options, b.brdf, given);
    return run_pieces(b.pieces, command_words(), chain_pieces(options, jobs), report);
}

// Returns the requested table, or nothing after a stop signal.
Result<std::optional<ltc::Table>> table_of(const LtcBake& b, const OptionTable& given, const Jobs& jobs, Report& report)
{
    const LtcArguments& a = b.options;
    if (!a.table.empty()) {
        Result<ltc::Table> read = ltc::read_table(a.table, given.given("--resolution") ? a.resolution : 0);
        BN_TRY(read);
        return std::optional(std::move(*read));
    }
    ltc::BakeOptions options = bake_options(a, b.brdf, given);
    if (b.pieces.merge) {
        const std::vector<JobPiece> pieces = chain_pieces(options, jobs);
        const auto files = finished_pieces(b.pieces, command_words(), pieces);
        BN_TRY(files);
        BN_TRY(take_chains(options, *files, pieces));
    } else {
        options.checkpoint = b.output + ".part";
    }
    std::optional<Progress> progress;
    progress.emplace("transformed cosines", ltc::bake_units(options), b.quiet);
    options.advance = [&progress](std::size_t units) { progress->step(units); };
    Result<std::optional<ltc::Baked>> baked = ltc::bake_table(options, jobs);
    progress.reset();
    BN_TRY(baked);
    if (!*baked)
        return std::optional<ltc::Table>();
    report.event("fit", fmt::format("mean L1 {:.4f} of nodes alone; {:.4f} between them, {:.4f} before", (*baked)->node_l1,
                                    (*baked)->fit_l1, (*baked)->fit_l1_before));
    BN_TRY(ltc::write_table(b.output, (*baked)->table, a.half));
    report.wrote(b.output);
    std::error_code ignored;
    fs::remove(options.checkpoint, ignored);
    return std::optional(std::move((*baked)->table));
}

} // namespace

int run_ltc(const LtcBake& b, const OptionTable& given)
{
    const LtcArguments& a = b.options;
    if (Status checked = check_arguments(b, given); !checked)
        return fail(checked.error());
    if (Status fits = check_preview(b.preview, names_of_ltc(), {b.output, a.table}); !fits)
        return fail(fits.error());
    Report report(b.quiet, b.verbosity);
    const Jobs jobs(b.threads);
    if (any_pieces(b.pieces) && !b.pieces.merge)
        return make_pieces(b, given, jobs, report);
    // Make or read the table
    const Result<std::optional<ltc::Table>> table = table_of(b, given, jobs, report);
    if (!table)
        return fail(table.error());
    report.release();
    stop_at_signals();
    if (*table && stop_signal() != 0)
        return 128 + stop_signal();
    if (!*table) {
        report.event("stopped", b.pieces.merge ? "no table was written"
                                               : fmt::format("the same command goes on from {}.part; no table was written", b.output));
        return 128 + stop_signal(); // as a shell reports a process ended by a signal
    }
    if (!b.preview.empty())
        if (Status written = write_preview(b.preview, preview_of_ltc(**table), report); !written)
            return fail(written.error());
    if (a.report.empty())
        return 0;
    // Measure its quality and draw the report
    const LtcQuality quality = measure_ltc(**table, a.cosines, jobs);
    Json figures = ltc_json(quality, **table);
    std::vector<std::pair<std::string, Drawing>> drawings = {{"quality", plot_ltc_quality(quality)}};
    std::string lines = ltc_lines(quality);
    if ((*table)->model() == ltc::Model::ggx && !(*table)->grid.round) { // published figures are for these lobes
        const LtcResolutions resolutions = measure_resolutions(**table, jobs);
        figures["resolutions"] = resolution_json(resolutions);
        drawings.emplace_back("resolutions", plot_resolutions(resolutions));
        lines += resolution_lines(resolutions);
    }
    if (Status written = write_report_files(a.report, figures, drawings, report); !written)
        return fail(written.error());
    report.figures(lines);
    return 0;
}

} // namespace burnish
