// `burnish train`: trains nets that make mipmaps.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/cli/command.h"
#include "apps/cli/lab.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/lab/mip/real_maps.h"
#include "apps/pieces/given.h"
#include "apps/pieces/pieces.h"
#include "apps/report/json.h"
#include "core/base/clock.h"
#include "shading/bake/mip/evaluate.h"
#include "shading/lab/mipnet/train.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    R"(mip: a cascade of two nets that makes mipmaps of normals and anisotropic widths. Each level looks like level 0 from afar (MIPNet, Gauthier
et al. 2022). Training uses materials made in code: tiles of 32 x 32 texels, lit from random directions at full detail and averaged. Every
level is compared with them as a display shows it. Layout cov starts from a closed form (covariances of normals added to widths) and learns
the rest; paper adds to plain means, as published. A stopped training leaves WEIGHTS.part, or the file of --checkpoint. The same command
continues from it to the same bytes, for every number of threads and every instruction set.
--evaluate measures weights against closed forms: on families outside the training, on new materials of trained families, and on pictures
with --maps. It prints FLIP, L1 and MSE of shaded levels, times 1000, as means over levels 1 to 5. --validation measures only new materials
of trained families, which serve for choosing weights.

Examples:
  burnish train mip --brdf ggx_aniso -o ggx_aniso.mipnet
  burnish train mip --brdf beckmann --layout paper --size 2x64/2x128 --steps 4000 -o paper.mipnet
  burnish train mip --evaluate ggx_aniso.mipnet --maps textures --json figures.json)";

// Returns a path's last component, for the command recorded in weight files. Keeps the machine's folders out.
std::string told_name(const std::string& path)
{
    const std::filesystem::path given(path);
    const std::string name = (given.has_filename() ? given : given.parent_path()).filename().string();
    return name.find(' ') == std::string::npos ? name : "'" + name + "'";
}

struct TrainArguments {
    std::string what = "mip", output, evaluate, maps, only_maps, from, taught_by, json, checkpoint;
    std::string size = "2x32/2x64";
    mipnet::TrainOptions train;
    PieceOptions pieces;
    bool validation = false, quiet = false;
    int verbosity = 0, threads = 0;
    Limits limits;
};

OptionTable train_option_table(TrainArguments& to)
{
    OptionTable table, limits;
    limits.add("", limit_options(to.limits));
    mipnet::TrainOptions& t = to.train;
    table.add("", {{"WHAT", "", "{}", choice(to.what, {"mip"})}});
    table.add("The nets", {{"--brdf", "NAME", "Reflection model that shades the mipmaps: {}",
                            choice(t.shape.lobe, {"ggx_aniso", "beckmann", "ashikhmin_shirley"})},
                           {"--layout", "NAME",
                            "Starting point of the nets: paper (plain means, as published) or cov (covariances of normals added to widths)",
                            choice(t.shape.layout, {"paper", "cov"})},
                           {"--size", "SIZE", "Hidden layers x units of both nets; 2x512/3x1024 is as published, 2x32 has no second net",
                            text(to.size)},
                           {"--footprint", "TEXELS", "Texels along a side of the second net's input, at its finest level: {}",
                            choice(t.shape.far, {"4", "8"})}});
    table.add("Training",
              {{"--steps", "N", "Training steps, each on 32 tiles", integer(t.steps, 1, 100000000)},
               {"--seed", "N", "Seed of all random numbers", integer(t.seed, 0, 1 << 30)},
               {"--loss", "NAME", "Loss on differences between shaded pictures: {}", choice(t.loss, {"l1", "l2", "charbonnier"})},
               {"--tone", "NAME", "Radiance in the loss: display (tonemapped) or log (log(1 + x))", choice(t.tone, {"display", "log"})},
               {"--mirrored", "SHARE", "Share of direction pairs near highlights, {}; the others are random", number(t.mirrored, 0.0, 1.0)},
               {"--light", "W", "Weight of a level's error in mean radiance, added to the loss, {}", number(t.light, 0.0, 10.0)},
               {"--levels", "N", "Levels in the loss: 2 use the second net once, 5 use it four times",
                integer(t.levels, 1, mipnet::kTrainedLevels)},
               {"--only-maps", "FOLDER", "Folder of materials to train on instead of those made in code; --maps adds to them",
                folder(to.only_maps)},
               {"--from", "WEIGHTS", "Weights to start from, with the same lobe, layout and size", file(to.from)},
               {"--taught-by", "WEIGHTS", "Weights whose levels are the truth, for the same lobe", file(to.taught_by)},
               {"--checkpoint", "FILE", "Checkpoint file for unfinished training", file(to.checkpoint), "WEIGHTS.part"}});
    table.add("Measuring",
              {{"--evaluate", "WEIGHTS", "Weights to measure, instead of training", file(to.evaluate)},
               {"--maps", "FOLDER",
                "Further materials, each a folder with normal, roughness and metallic maps: measured with --evaluate, else trained on",
                folder(to.maps)},
               {"--validation", "", "Measure on validation materials only, none of the test materials", flag(to.validation)},
               Option("--json", "FILE", "Figures of every material and level", file(to.json)).is_output()});
    table.add("Pieces of --evaluate, for several processes", piece_options(to.pieces));
    table.add("Output", {Option("-o,--output", "FILE", "Weights file to write", file(to.output)).is_output(), quiet_option(to.quiet),
                         verbose_option(to.verbosity), threads_option(to.threads)});
    table.take(limits, "Limits on input",
               {{"--limit-image-side", "Width and height of an input picture"}, {"--limit-file-bytes", "Size of one input file"}});
    return table;
}

Status check_arguments(TrainArguments& a, const OptionTable& given)
{
    if (a.evaluate.empty() == a.output.empty())
        return usage_error("-o", "is needed, or --evaluate, and not both");
    if (a.evaluate.empty())
        for (const char* option : {"--validation", "--json"})
            if (given.given(option))
                return usage_error(option, "needs --evaluate WEIGHTS");
    if (!a.evaluate.empty())
        for (const char* option : {"--brdf", "--layout", "--size", "--footprint", "--steps", "--seed", "--loss", "--tone", "--mirrored",
                                   "--light", "--levels", "--only-maps", "--from", "--taught-by", "--checkpoint"})
            if (given.given(option))
                return usage_error(option, "says how nets are trained, and those of --evaluate are trained already");
    BN_TRY(check_piece_options(a.pieces));
    if (a.evaluate.empty() && any_pieces(a.pieces))
        return usage_error("--evaluate", "is needed: measuring has pieces, and each step of a training needs the one before");
    if (!mipnet::read_size(a.size, a.train.shape))
        return usage_error("--size", fmt::format("'{}' is not of the kind 2x32/2x64: 1 to {} layers of 1 to {} units", a.size,
                                                 mipnet::kMostHidden, mipnet::kMostWidth));
    if (a.train.shape.far && a.train.shape.b.layers == 0)
        return usage_error("--footprint", "is the second net's, and --size " + a.size + " has none");
    if (!a.maps.empty() && !a.only_maps.empty())
        return usage_error("--only-maps", "and --maps: one of them");
    if (a.validation && !a.maps.empty())
        return usage_error("--maps", "are for reports, --validation is for what is chosen");
    if (a.output == "-")
        return usage_error("-o", "weights are no text for standard output");
    if (!a.json.empty())
        if (const Status path = check_text_path("--json", a.json, {a.evaluate}); !path)
            return path;
    if (a.output.empty())
        return {};
    if (const Status path = check_text_path("-o", a.output, {}); !path)
        return path;
    return check_text_path("--checkpoint", a.train.checkpoint, {});
}

// Reads the training inputs that are given as files.
Status read_given(TrainArguments& a)
{
    mipnet::TrainOptions& t = a.train;
    if (t.only_maps = !a.only_maps.empty(); t.only_maps || !a.maps.empty()) {
        const std::string& folder = t.only_maps ? a.only_maps : a.maps;
        Result<std::vector<mipnet::TestMaterial>> maps = real_materials(folder, a.limits);
        BN_TRY(maps);
        for (mipnet::TestMaterial& m : *maps)
            t.maps.push_back(std::move(m.material));
    }
    if (!a.taught_by.empty()) {
        Result<mipnet::Weights> read = mipnet::read_weights(a.taught_by);
        BN_TRY(read);
        if (read->shape.lobe != t.shape.lobe)
            return Error{ExitCode::bad_input, a.taught_by, "",
                         fmt::format("is of lobes of {}, not of {}", mipnet::lobe_name(read->shape.lobe), mipnet::lobe_name(t.shape.lobe))};
        t.taught_by = std::make_shared<const mipnet::Weights>(std::move(*read));
    }
    if (a.from.empty())
        return {};
    Result<mipnet::Weights> read = mipnet::read_weights(a.from);
    BN_TRY(read);
    if (!(read->shape == t.shape))
        return Error{ExitCode::bad_input, a.from, "",
                     fmt::format("is of lobes of {}, layout {}, size {} and footprint {}, other than what is to be trained",
                                 mipnet::lobe_name(read->shape.lobe), mipnet::layout_name(read->shape.layout),
                                 mipnet::size_name(read->shape), read->shape.far ? 8 : 4)};
    t.from = std::make_shared<const mipnet::Weights>(std::move(*read));
    return {};
}

// Returns the command that makes the same weights, without their name.
std::string command_of(const TrainArguments& a)
{
    const mipnet::TrainOptions& t = a.train;
    std::string words = fmt::format("burnish train mip --brdf {} --layout {} --size {} --steps {} --seed {}", lobe_name(t.shape.lobe),
                                    layout_name(t.shape.layout), size_name(t.shape), t.steps, t.seed);
    if (t.loss != mipnet::Loss::l1)
        words += t.loss == mipnet::Loss::l2 ? " --loss l2" : " --loss charbonnier";
    if (t.tone != mipnet::Tone::display)
        words += " --tone log";
    if (t.mirrored != mipnet::kDefaultMirrored)
        words += fmt::format(" --mirrored {}", t.mirrored);
    if (t.light != 0.0)
        words += fmt::format(" --light {}", t.light);
    if (t.shape.far)
        words += " --footprint 8";
    if (t.levels != mipnet::kTrainedLevels)
        words += fmt::format(" --levels {}", t.levels);
    if (!t.maps.empty())
        words += fmt::format(" {} {}", t.only_maps ? "--only-maps" : "--maps", told_name(t.only_maps ? a.only_maps : a.maps));
    if (t.from)
        words += fmt::format(" --from {}", told_name(a.from));
    if (t.taught_by)
        words += fmt::format(" --taught-by {}", told_name(a.taught_by));
    return words;
}

int run_training(TrainArguments& a, Report& report)
{
    if (const Status given = read_given(a); !given)
        return fail(given.error());
    const Jobs jobs(a.threads);
    a.train.stop = &watch_stop_signals();
    report.release();
    // Report the mean loss twenty times
    const double begin_ms = wall_ms();
    const int told = std::max(1, a.train.steps / 20);
    double sum = 0.0;
    int summed = 0;
    std::optional<Progress> progress;
    progress.emplace("steps", static_cast<std::size_t>(a.train.steps), a.quiet);
    int seen = 0;
    a.train.advance = [&](int step, double loss) {
        progress->step(static_cast<std::size_t>(step - seen));
        seen = step;
        sum += loss, ++summed;
        if (step % told != 0 && step != a.train.steps)
            return;
        report.event("step", fmt::format("{} of {}: loss {:.2f}e-3, {:.0f} s", step, a.train.steps, 1e3 * sum / summed,
                                         1e-3 * (wall_ms() - begin_ms)));
        sum = 0.0, summed = 0;
    };
    a.train.command = command_of(a);
    const Result<std::optional<mipnet::Weights>> trained = mipnet::train(a.train, jobs);
    progress.reset();
    if (!trained)
        return fail(trained.error());
    if (!*trained) {
        report.event("stopped", fmt::format("the same command goes on from {}; no weights were written", a.train.checkpoint));
        return 128 + stop_signal(); // as a shell reports a process ended by a signal
    }
    if (const Status written = mipnet::write_weights(a.output, **trained); !written)
        return fail(written.error());
    report.wrote(a.output);
    std::error_code ignored;
    fs::remove(a.train.checkpoint, ignored);
    return 0;
}

Json figures_json(const MipError& f)
{
    return {{"flip", f.flip}, {"l1", f.l1}, {"mse", f.mse}, {"light", f.light}};
}

std::string summary_lines(const std::vector<mipnet::Summary>& all)
{
    std::string lines = fmt::format("{:10} {:10} {:>4} {:>7} {:>7} {:>7}   {:>6} {:>6} {:>6}   {:>5} {:>6}  {}\n", "set", "filter", "of",
                                    "FLIP", "L1", "MSE", "dFLIP", "dL1", "dMSE", "worst", "LoD1", "wins FLIP/L1/MSE");
    const mipnet::Summary* base = nullptr;
    for (const mipnet::Summary& s : all) {
        if (s.filter == "baseline")
            base = &s;
        const auto change = [](double is, double was) { return 100.0 * (is / was - 1.0); };
        const MipError &m = s.mean, &b = base->mean;
        lines += fmt::format(
            "{:10} {:10} {:4} {:7.1f} {:7.2f} {:7.2f}   {:+5.1f}% {:+5.1f}% {:+5.1f}%   {:5.2f} {:6.2f}  {:.0f}/{:.0f}/{:.0f} %\n", s.set,
            s.filter, s.materials, 1e3 * m.flip, 1e3 * m.l1, 1e3 * m.mse, change(m.flip, b.flip), change(m.l1, b.l1), change(m.mse, b.mse),
            s.worst_l1, 1e3 * s.first_level_l1, 100.0 * s.wins[0], 100.0 * s.wins[1], 100.0 * s.wins[2]);
    }
    return lines;
}

Json rows_json(const std::vector<mipnet::Judged>& rows)
{
    Json json = Json::array();
    for (const mipnet::Judged& row : rows) {
        Json levels = Json::array();
        for (int k = 1; k <= mipnet::kJudgedLevels; ++k)
            levels.push_back(figures_json(row.level[k]));
        json.push_back({{"set", row.set},
                        {"material", row.material},
                        {"filter", row.filter},
                        {"mean", figures_json(row.level[0])},
                        {"levels", levels}});
    }
    return json;
}

MipError figures_of(const Json& json)
{
    MipError f;
    f.flip = json.at("flip"), f.l1 = json.at("l1"), f.mse = json.at("mse"), f.light = json.at("light");
    return f;
}

// Reads rows_json(). Throws where something is missing.
std::vector<mipnet::Judged> rows_of(const Json& json)
{
    std::vector<mipnet::Judged> rows;
    for (const Json& from : json) {
        mipnet::Judged row{from.at("set"), from.at("material"), from.at("filter"), {}};
        row.level[0] = figures_of(from.at("mean"));
        for (int k = 1; k <= mipnet::kJudgedLevels; ++k)
            row.level[k] = figures_of(from.at("levels").at(static_cast<std::size_t>(k - 1)));
        rows.push_back(row);
    }
    return rows;
}

// A piece holds the figures of one material.
std::vector<JobPiece> judged_pieces(const std::vector<mipnet::TestMaterial>& set, const mipnet::Weights& weights, const std::string& text,
                                    const Jobs& jobs)
{
    const auto rate = std::make_shared<std::optional<double>>(); // seconds a texel, by the first material
    const auto texels_of = [](const mipnet::TestMaterial& m) {
        return static_cast<double>(m.material.texels.width) * static_cast<double>(m.material.texels.height);
    };
    std::vector<JobPiece> pieces;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto judged = [&set, &weights, &jobs, i] { return mipnet::judge({set[i]}, weights.shape.lobe, {weights}, jobs); };
        const std::string key = piece_key(fmt::format("train {} {}{}", i, set[i].material.name, text));
        const auto seconds = [judged, rate, texels = texels_of(set[i])]() -> Result<double> {
            if (!*rate) {
                const double begin = wall_ms();
                judged();
                *rate = (wall_ms() - begin) * 1e-3 / texels;
            }
            return **rate * texels;
        };
        const auto make = [judged, key](const std::string& file) -> Status {
            const std::string rows = rows_json(judged()).dump();
            return write_piece(file, key, {rows.begin(), rows.end()});
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

Result<std::vector<mipnet::Judged>> merged_rows(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    std::vector<mipnet::Judged> all;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        try {
            for (mipnet::Judged& row : rows_of(Json::parse(content->begin(), content->end())))
                all.push_back(std::move(row));
        } catch (const nlohmann::json::exception&) {
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        }
    }
    return all;
}

int run_evaluation(const TrainArguments& a, const OptionTable& given, Report& report)
{
    const Result<mipnet::Weights> weights = mipnet::read_weights(a.evaluate);
    if (!weights)
        return fail(weights.error());
    const Jobs jobs(a.threads);
    std::vector<mipnet::TestMaterial> set = a.validation ? mipnet::make_validation_set(jobs) : mipnet::make_test_set(jobs);
    if (!a.maps.empty()) {
        Result<std::vector<mipnet::TestMaterial>> real = real_materials(a.maps, a.limits);
        if (!real)
            return fail(real.error());
        set.insert(set.end(), real->begin(), real->end());
    }
    // List or make pieces, take their rows, or judge all materials
    const std::vector<JobPiece> pieces =
        any_pieces(a.pieces) ? judged_pieces(set, *weights, text_of_given(given), jobs) : std::vector<JobPiece>();
    if (any_pieces(a.pieces) && !a.pieces.merge)
        return run_pieces(a.pieces, kept_words(), pieces, report);
    std::vector<mipnet::Judged> rows;
    if (a.pieces.merge) {
        const auto files = finished_pieces(a.pieces, kept_words(), pieces);
        if (!files)
            return fail(files.error());
        Result<std::vector<mipnet::Judged>> merged = merged_rows(*files, pieces);
        if (!merged)
            return fail(merged.error());
        rows = std::move(*merged);
    } else {
        rows = mipnet::judge(set, weights->shape.lobe, {*weights}, jobs);
    }
    report.promise_stdout({a.json});
    report.release();
    if (!a.json.empty()) {
        const Json json = {{"brdf", mipnet::lobe_name(weights->shape.lobe)}, {"command", weights->command}, {"rows", rows_json(rows)}};
        if (const Status written = write_text(a.json, json_text(json, 1) + "\n"); !written)
            return fail(written.error());
        report.wrote(a.json);
    }
    report.figures(summary_lines(mipnet::summaries(rows)));
    return 0;
}

int run_train(TrainArguments& a, const OptionTable& given)
{
    if (a.train.checkpoint = a.checkpoint; a.checkpoint.empty())
        a.train.checkpoint = a.output + ".part";
    if (const Status checked = check_arguments(a, given); !checked)
        return fail(checked.error());
    Report report(a.quiet, a.verbosity);
    return a.evaluate.empty() ? run_training(a, report) : run_evaluation(a, given, report);
}

} // namespace

Command train_command()
{
    auto arguments = std::make_shared<TrainArguments>();
    return {"train", "Train and measure neural nets that make mipmaps", train_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_train(*arguments, given); }};
}

} // namespace burnish
