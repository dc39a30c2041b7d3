// Training of nets that make mipmaps: one for each seed, of which the best is written.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <optional>

#include "apps/cli/outputs.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/words.h"
#include "apps/lab/mip/real_maps.h"
#include "apps/lab/train/arguments.h"
#include "apps/pieces/given.h"
#include "core/base/clock.h"
#include "shading/lab/mip/judge_filters.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Returns a path's last component, for the command recorded in weight files. Keeps the machine's folders out.
std::string told_name(const std::string& path)
{
    const std::filesystem::path given(path);
    const std::string name = (given.has_filename() ? given : given.parent_path()).filename().string();
    return name.find(' ') == std::string::npos ? name : "'" + name + "'";
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
    if (!a.distilled_from.empty()) {
        Result<mipnet::Weights> read = mipnet::read_weights(a.distilled_from);
        BN_TRY(read);
        if (read->shape.lobe != t.shape.lobe)
            return Error{ExitCode::bad_input, a.distilled_from, "",
                         fmt::format("is of lobes of {}, not of {}", mipnet::lobe_name(read->shape.lobe), mipnet::lobe_name(t.shape.lobe))};
        t.distilled_from = std::make_shared<const mipnet::Weights>(std::move(*read));
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

// Returns the command that makes the weights of one seed, without their name.
std::string command_of(const TrainArguments& a, std::uint64_t seed)
{
    const mipnet::TrainOptions& t = a.train;
    std::string words = fmt::format("burnish train mip --brdf {} --layout {} --size {} --steps {} --seed {}", lobe_name(t.shape.lobe),
                                    layout_name(t.shape.layout), size_name(t.shape), t.steps, seed);
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
    if (t.distilled_from)
        words += fmt::format(" --taught-by {}", told_name(a.distilled_from));
    return words;
}

// Trains one seed. Returns nothing if a signal stopped the training.
Result<std::optional<mipnet::Weights>> train_seed(const TrainArguments& a, std::uint64_t seed, const std::string& checkpoint,
                                                  const Jobs& jobs, Report& report)
{
    mipnet::TrainOptions options = a.train;
    options.seed = seed, options.checkpoint = checkpoint, options.command = command_of(a, seed), options.stop = &watch_stop_signals();
    // Report the mean loss twenty times
    const double begin_ms = wall_ms();
    const int told = std::max(1, options.steps / 20);
    double sum = 0.0;
    int summed = 0, seen = 0;
    Progress progress("steps", static_cast<std::size_t>(options.steps), a.quiet);
    options.advance = [&](int step, double loss) {
        progress.step(static_cast<std::size_t>(step - seen));
        seen = step;
        sum += loss, ++summed;
        if (step % told != 0 && step != options.steps)
            return;
        report.event("step", fmt::format("{} of {}: loss {:.2f}e-3, {:.0f} s", step, options.steps, 1e3 * sum / summed,
                                         1e-3 * (wall_ms() - begin_ms)));
        sum = 0.0, summed = 0;
    };
    return mipnet::train(options, jobs);
}

struct Candidate {
    double l1 = 0.0; // mean over the validation materials
    mipnet::Weights weights;
};

// Returns the mean L1 of shaded levels over the validation materials.
double validation_l1(const mipnet::Weights& weights, const Jobs& jobs)
{
    const std::vector<mipnet::Judged> rows = mipnet::judge(mipnet::make_validation_set(jobs), weights.shape.lobe, {weights}, jobs);
    const std::vector<mipnet::Summary> all = mipnet::summaries(rows);
    return std::find_if(all.begin(), all.end(), [](const mipnet::Summary& s) { return s.filter == "mipnet"; })->mean.l1;
}

// Returns the number of the best candidate. The first wins among equals, a number wins over NaN.
std::size_t best_of(const std::vector<Candidate>& candidates)
{
    std::size_t best = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i)
        if (candidates[i].l1 < candidates[best].l1 || std::isnan(candidates[best].l1))
            best = i;
    return best;
}

// Writes the best candidate's weights.
Status write_best(const TrainArguments& a, const std::vector<Candidate>& candidates, Report& report)
{
    const std::size_t best = best_of(candidates);
    if (candidates.size() > 1)
        for (std::size_t i = 0; i < candidates.size(); ++i)
            report.event("seed", fmt::format("{}: L1 {:.4f}e-3 on the validation materials{}", candidates[i].weights.seed,
                                             1e3 * candidates[i].l1, i == best ? ", the best" : ""));
    BN_TRY(mipnet::write_weights(a.output, candidates[best].weights));
    report.wrote(a.output);
    return {};
}

// Estimates the time of one seed from a few steps, and from judging their weights, s.
Result<double> seconds_of_seed(const TrainArguments& a, const Jobs& jobs)
{
    constexpr int kSteps[] = {1, 5};
    double taken[2] = {}, judging = 0.0;
    for (int k = 0; k < 2; ++k) {
        mipnet::TrainOptions few = a.train;
        few.steps = kSteps[k], few.checkpoint.clear(), few.stop = &watch_stop_signals();
        const double begin = wall_ms();
        const Result<std::optional<mipnet::Weights>> trained = mipnet::train(few, jobs);
        BN_TRY(trained);
        taken[k] = (wall_ms() - begin) * 1e-3;
        if (k > 0 && *trained) {
            validation_l1(**trained, jobs);
            judging = (wall_ms() - begin) * 1e-3 - taken[k];
        }
    }
    return taken[0] + std::max(0.0, taken[1] - taken[0]) / (kSteps[1] - kSteps[0]) * (a.train.steps - 1) + judging;
}

// A piece holds the weights of one seed behind their L1. A stopped piece continues from a checkpoint beside it.
std::vector<JobPiece> seed_pieces(const TrainArguments& a, const Jobs& jobs, Report& report)
{
    const auto estimate = std::make_shared<std::optional<double>>();                                  // s, for any seed
    const std::string text = text_of_scene("train", {a.maps, a.only_maps, a.from, a.distilled_from}); // by content
    std::vector<JobPiece> pieces;
    for (int i = 0; i < a.seeds; ++i) {
        const std::uint64_t seed = a.train.seed + static_cast<std::uint64_t>(i);
        const std::string key = piece_key(command_of(a, seed) + text);
        const auto seconds = [&a, &jobs, estimate]() -> Result<double> {
            if (!*estimate) {
                const Result<double> measured = seconds_of_seed(a, jobs);
                BN_TRY(measured);
                *estimate = *measured;
            }
            return **estimate;
        };
        const auto make = [&a, &jobs, &report, seed, key](const std::string& file) -> Status {
            const std::string checkpoint = file + ".part";
            Result<std::optional<mipnet::Weights>> trained = train_seed(a, seed, checkpoint, jobs, report);
            if (!trained && trained.error().file == checkpoint) { // a damaged one: begin anew
                std::error_code ignored;
                fs::remove(checkpoint, ignored);
                trained = train_seed(a, seed, checkpoint, jobs, report);
            }
            BN_TRY(trained);
            if (!*trained)
                return {};
            std::vector<std::uint8_t> content(sizeof(double));
            const double l1 = validation_l1(**trained, jobs);
            std::memcpy(content.data(), &l1, sizeof l1);
            const std::vector<std::uint8_t> bytes = mipnet::weights_bytes(**trained);
            content.insert(content.end(), bytes.begin(), bytes.end());
            BN_TRY(write_piece(file, key, content));
            std::error_code ignored;
            fs::remove(checkpoint, ignored);
            return {};
        };
        pieces.push_back({key, seconds, make});
    }
    return pieces;
}

Result<std::vector<Candidate>> candidates_of(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        Candidate candidate;
        if (content->size() < sizeof candidate.l1)
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        std::memcpy(&candidate.l1, content->data(), sizeof candidate.l1);
        Result<mipnet::Weights> weights =
            mipnet::parse_weights(content->data() + sizeof candidate.l1, content->size() - sizeof candidate.l1, files[i]);
        BN_TRY(weights);
        candidate.weights = std::move(*weights);
        candidates.push_back(std::move(candidate));
    }
    return candidates;
}

// Trains all seeds in this process. Finished seeds keep their checkpoint until the best is written.
int train_all(const TrainArguments& a, const Jobs& jobs, Report& report)
{
    std::vector<Candidate> candidates;
    std::vector<std::string> checkpoints;
    for (int i = 0; i < a.seeds; ++i) {
        const std::uint64_t seed = a.train.seed + static_cast<std::uint64_t>(i);
        checkpoints.push_back(a.seeds == 1 ? a.train.checkpoint : fmt::format("{}.{}", a.train.checkpoint, seed));
        const Result<std::optional<mipnet::Weights>> trained = train_seed(a, seed, checkpoints.back(), jobs, report);
        if (!trained)
            return fail(trained.error());
        if (!*trained) {
            report.event("stopped", fmt::format("the same command goes on from {}; no weights were written", checkpoints.back()));
            return 128 + stop_signal(); // as a shell reports a process ended by a signal
        }
        candidates.push_back({a.seeds == 1 ? 0.0 : validation_l1(**trained, jobs), **trained});
    }
    if (const Status written = write_best(a, candidates, report); !written)
        return fail(written.error());
    std::error_code ignored;
    for (const std::string& checkpoint : checkpoints)
        fs::remove(checkpoint, ignored);
    return 0;
}

} // namespace

int run_training(TrainArguments& a, Report& report)
{
    if (const Status read = read_given(a); !read)
        return fail(read.error());
    const Jobs jobs(a.threads);
    if (!any_pieces(a.pieces)) {
        report.release();
        return train_all(a, jobs, report);
    }
    const std::vector<JobPiece> pieces = seed_pieces(a, jobs, report);
    if (!a.pieces.merge)
        return run_pieces(a.pieces, command_words(), pieces, report);
    const auto files = finished_pieces(a.pieces, command_words(), pieces);
    if (!files)
        return fail(files.error());
    const Result<std::vector<Candidate>> candidates = candidates_of(*files, pieces);
    if (!candidates)
        return fail(candidates.error());
    report.release();
    const Status written = write_best(a, *candidates, report);
    return written ? 0 : fail(written.error());
}

} // namespace burnish
