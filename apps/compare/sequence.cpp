// Compares a picture sequence with a reference sequence: each picture's error, and flicker. Flicker is the mean FLIP between successive
// pictures minus the same for the reference: moving things may change, but no more.
#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "apps/cli/numbered.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/compare/alpha.h"
#include "apps/compare/folders.h"
#include "apps/compare/sequence_page.h"
#include "apps/compare/verdict.h"
#include "apps/report/json.h"
#include "core/image/io/image_io.h"
#include "core/image/metrics/metrics.h"

namespace burnish {
namespace {

struct Frames {
    int number = 0;
    Image reference, test;
    std::string note; // on alpha, if only one picture has alpha
};

double mean_of(const Image& errors)
{
    return summarise_errors(errors).mean;
}

std::string shape_of(const Image& image)
{
    return fmt::format("{}x{}, {}, {}", image.width, image.height, counted(static_cast<std::uint64_t>(image.channels), "channel"),
                       image.type == PixelType::f32 ? "floats" : "display values");
}

Status check_like(const std::string& name, const Image& image, const std::string& first_name, const Image& first)
{
    if (image.width != first.width || image.height != first.height || image.channels != first.channels ||
        (image.type == PixelType::f32) != (first.type == PixelType::f32))
        return Error{ExitCode::size_mismatch, name, "", fmt::format("{}; {} has {}", shape_of(image), first_name, shape_of(first))};
    if (const std::int64_t bad = not_finite_pixels(image, image))
        return Error{ExitCode::not_finite, name, "", fmt::format("{} pixels are NaN or Inf", bad)};
    return {};
}

// Returns the frames' rows for CSV: with the names of the frame's files, and with limits and verdict of the sequence.
Json csv_rows(const CompareOptions& options, const Status& verdict, const Json& by_frame)
{
    Json rows = Json::array();
    for (const Json& frame : by_frame) {
        Json row = verdict_json(options, verdict);
        const int number = frame["frame"].get<int>();
        row["reference"] = numbered(options.reference, number), row["test"] = numbered(options.test, number);
        row.update(frame);
        rows.push_back(std::move(row));
    }
    return rows;
}

// Returns the frame numbers. Both sequences must have the same numbers, without gaps.
Result<std::vector<int>> numbers_of(const CompareOptions& options)
{
    const Result<std::vector<int>> reference = existing_numbers(options.reference), test = existing_numbers(options.test);
    BN_TRY(reference);
    BN_TRY(test);
    for (const auto& [mine, others, pattern] :
         {std::tuple{&*reference, &*test, &options.test}, std::tuple{&*test, &*reference, &options.reference}})
        for (const int number : *mine)
            if (!std::binary_search(others->begin(), others->end(), number))
                return Error{ExitCode::bad_input, numbered(*pattern, number), "", "is missing"};
    if (reference->size() < 2)
        return Error{ExitCode::bad_input, options.reference, "",
                     fmt::format("names {}, two are the least", counted(reference->size(), "file"))};
    for (std::size_t i = 1; i < reference->size(); ++i)
        if ((*reference)[i] != (*reference)[i - 1] + 1)
            return Error{ExitCode::bad_input, numbered(options.reference, (*reference)[i - 1] + 1), "", "is missing"};
    return *reference;
}

Result<Frames> read_frames(const CompareOptions& options, int number, const Image* first, std::set<std::string>& said, Report& report)
{
    Frames frames;
    frames.number = number;
    for (const auto& [pattern, to] : {std::pair{&options.reference, &frames.reference}, {&options.test, &frames.test}}) {
        const std::string name = numbered(*pattern, number);
        PictureNotes notes;
        Result<Image> image = read_colours(name, options.limits, notes);
        BN_TRY(image);
        for (const std::string& warning : notes.warnings)
            if (said.insert(warning).second) // once, for the first picture
                report.warning(name + ": " + warning);
        *to = std::move(*image);
    }
    Result<std::string> note =
        drop_lone_alpha(frames.reference, numbered(options.reference, number), frames.test, numbered(options.test, number));
    BN_TRY(note);
    frames.note = std::move(*note);
    const Image& like = first ? *first : frames.reference;
    for (const auto& [pattern, image] : {std::pair{&options.reference, &frames.reference}, {&options.test, &frames.test}})
        BN_TRY(check_like(numbered(*pattern, number), *image, options.reference, like));
    return frames;
}

// Figures over all frames. take_means() turns the sums of changes into means.
struct SequenceFigures {
    Json rows = Json::array(); // by frame
    double errors = 0.0;       // sum of the frames' mean FLIP
    double worst = 0.0;        // largest mean FLIP
    int worst_number = 0;      // its frame
    double test_changes = 0.0, reference_changes = 0.0;
    double mean_error = 0.0, flicker = 0.0; // from take_means()
};

// FLIP with the same settings for all differences of a frame.
struct FrameFlip {
    FlipOptions options;
    bool hdr;
    const Jobs& jobs;

    double measure(const Image& a, const Image& b) const
    {
        return mean_of((hdr ? flip_hdr(a, b, options, jobs) : flip_ldr(a, b, options, jobs)).error);
    }
};

FrameFlip choose_flip(const CompareOptions& options, const Image& reference, const Jobs& jobs)
{
    const bool hdr = reference.type == PixelType::f32 && !(options.metrics && options.metrics->flip);
    FrameFlip flip{options.flip, hdr, jobs};
    if (hdr) { // all four differences use the reference's exposures
        const FlipExposures range = find_exposures(reference, flip.options, jobs);
        flip.options.start_ev = range.start_ev, flip.options.stop_ev = range.stop_ev, flip.options.exposures = range.count;
    }
    return flip;
}

// Compares a frame with its reference and with the previous frame.
void add_frame(const Frames& frames, const std::optional<Frames>& before, const FrameFlip& flip, SequenceFigures& figures)
{
    Json row;
    row["frame"] = frames.number;
    const double error = flip.measure(frames.reference, frames.test);
    row["flip_mean"] = error;
    figures.errors += error;
    if (error > figures.worst)
        figures.worst = error, figures.worst_number = frames.number;
    if (before) {
        const double of_reference = flip.measure(before->reference, frames.reference), of_test = flip.measure(before->test, frames.test);
        row["change"] = of_test, row["reference_change"] = of_reference;
        figures.test_changes += of_test, figures.reference_changes += of_reference;
    }
    figures.rows.push_back(std::move(row));
}

void take_means(std::size_t frames, SequenceFigures& figures)
{
    const double count = static_cast<double>(frames);
    figures.test_changes /= count - 1.0, figures.reference_changes /= count - 1.0;
    figures.flicker = figures.test_changes - figures.reference_changes;
    figures.mean_error = figures.errors / count;
}

void report_sequence(const std::vector<int>& numbers, const SequenceFigures& figures, Report& report)
{
    report.figure("frames", fmt::format("{} to {}", numbers.front(), numbers.back()));
    report.figure("FLIP mean", fmt::format("{:.6f}, at most {:.6f} in frame {}", figures.mean_error, figures.worst, figures.worst_number));
    report.figure("changes",
                  fmt::format("{:.6f} from frame to frame, {:.6f} of the reference", figures.test_changes, figures.reference_changes));
    report.figure("flicker", fmt::format("{:.6f}", figures.flicker));
}

// Returns an Error with ExitCode::differ for the first limit exceeded.
Status judge_sequence(const CompareOptions& options, const SequenceFigures& figures)
{
    Status verdict;
    for (const auto& [option, limit, value, what] : {std::tuple{"--fail-flip", options.fail_flip, figures.mean_error, "FLIP's mean"},
                                                     std::tuple{"--fail-flicker", options.fail_flicker, figures.flicker, "flicker"}})
        if (verdict && limit && value > *limit)
            verdict = Error{ExitCode::differ, options.test, option, fmt::format("{} is {:.6f}, more than {:g}", what, value, *limit)};
    return verdict;
}

Json describe_sequence(const CompareOptions& options, const Status& verdict, const SequenceFigures& figures)
{
    Json json = verdict_json(options, verdict);
    json["frames"] = figures.rows.size(), json["flip_mean"] = figures.mean_error;
    json["flip_worst"] = figures.worst, json["worst_frame"] = figures.worst_number;
    json["change"] = figures.test_changes, json["reference_change"] = figures.reference_changes, json["flicker"] = figures.flicker;
    json["by_frame"] = figures.rows;
    return json;
}

// Writes the outputs, trying each. Returns the first failure.
Status write_sequence(const CompareOptions& options, const Status& verdict, const SequenceFigures& figures, const Jobs& jobs,
                      Report& report)
{
    const Json json = describe_sequence(options, verdict, figures);
    Status written;
    const auto write = [&](const std::string& path, const auto& text_of) {
        if (path.empty())
            return;
        const Result<std::string> text = text_of();
        const Status status = text ? write_text(path, *text) : Status(text.error());
        if (status)
            report.wrote(path);
        else if (written)
            written = status;
        else
            fail(status.error());
    };
    write(options.json, [&] { return Result<std::string>(json_text(json, 2) + "\n"); });
    write(options.csv, [&] { return Result<std::string>(csv_text(csv_rows(options, verdict, figures.rows))); });
    write(options.junit, [&] { return Result<std::string>(compare_junit({verdict_case(options.test, verdict)})); });
    write(options.html, [&] { return sequence_page(options, verdict, json, jobs); });
    return written;
}

} // namespace

int compare_sequences(const CompareOptions& options)
{
    const Result<std::vector<int>> numbers = numbers_of(options);
    if (!numbers)
        return fails_unread(options, numbers.error());
    const Jobs jobs(options.threads);
    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.json, options.csv, options.junit, options.html});
    report.release();
    SequenceFigures figures;
    figures.worst_number = numbers->front();
    std::optional<Frames> before;
    std::set<std::string> said;
    bool noted = false;
    for (const int number : *numbers) {
        Result<Frames> frames = read_frames(options, number, before ? &before->reference : nullptr, said, report);
        if (!frames)
            return fails_unread(options, frames.error());
        if (!frames->note.empty() && !noted)
            report.event("note", frames->note), noted = true; // once, for the first picture
        if (options.metrics && options.metrics->flip_hdr && frames->reference.type != PixelType::f32)
            return fail(usage_error("--metric", "flip-hdr needs float pictures"));
        add_frame(*frames, before, choose_flip(options, frames->reference, jobs), figures);
        before = std::move(*frames);
    }
    take_means(numbers->size(), figures);
    report_sequence(*numbers, figures, report);
    const Status verdict = judge_sequence(options, figures);
    const Status written = write_sequence(options, verdict, figures, jobs, report);
    const int code = verdict ? 0 : fail(verdict.error());
    return written ? code : fail(written.error());
}

} // namespace burnish
