// `burnish atlas`: measures and shows where each method breaks, and compares with the golden figures.
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/words.h"
#include "apps/lab/atlas/assets.h"
#include "apps/lab/atlas/options.h"
#include "apps/lab/atlas/page.h"
#include "apps/live/live.h"
#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/jobs/activity.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxTableBytes = 16ull << 20;
constexpr const char* kFooter =
    R"(Each entry is a path of pictures from settings where a method holds to settings where it fails, measured against a reference.
DIR gets index.html with the pictures, atlas.json, and finished entries; a stopped atlas continues from those.

Exit codes: 0 all entries hold, 1 an entry is worse than its golden figures or its cure fails, 2 wrong option, 7 output not written, 77 no
Embree, which the reference needs.

Examples:
  burnish atlas --list
  burnish atlas --quick -o atlas
  burnish atlas bent_normal_bends_too_far -o bent
  burnish atlas --quick --with "--axis-beta 1.15"
  burnish atlas --quick --bless --table apps/lab/atlas/golden_figures.txt)";

int list_entries(const AtlasOptions& options)
{
    std::string group;
    for (const AtlasEntry& entry : options.entries()) {
        if (group != entry.group)
            fmt::print("{}{}:\n", group.empty() ? "" : "\n", entry.group);
        group = entry.group;
        fmt::print("  {}\n      {}\n      burnish render {}, {}\n", entry.id, entry.breaks, entry.words, path_text(entry));
    }
    return 0;
}

Result<GoldenTable> golden_table(const AtlasOptions& options)
{
    if (options.table.empty())
        return parse_table(std::string(kAtlasGolden.bytes, kAtlasGolden.size), "the program's own table");
    std::error_code ignored; // read_file() reports the reason
    if (options.bless && fs::status(options.table, ignored).type() == fs::file_type::not_found)
        return GoldenTable();
    const Result<std::vector<std::uint8_t>> bytes = read_file(options.table, kMaxTableBytes);
    BN_TRY(bytes);
    return parse_table(std::string(bytes->begin(), bytes->end()), options.table);
}

// Files of an earlier walk of an entry in DIR.
struct CachedFiles {
    std::string key, json, strip;
};

CachedFiles cached_files(const AtlasOptions& options, const AtlasEntry& entry)
{
    const std::string stem = fmt::format("{}/{}-{}", options.folder, entry.id, options.walk().name);
    return {entry_key(entry, options.walk()), stem + ".json", stem + ".png"};
}

std::optional<MeasuredEntry> read_cached(const CachedFiles& files)
{
    std::error_code ignored;
    if (!fs::exists(files.json, ignored) || !fs::exists(files.strip, ignored))
        return std::nullopt;
    const Result<std::vector<std::uint8_t>> bytes = read_file(files.json, kMaxTableBytes);
    return bytes ? parse_cached_entry(std::string(bytes->begin(), bytes->end()), files.key) : std::nullopt;
}

class Atlas {
  public:
    Atlas(const AtlasOptions& options, GoldenTable golden, Report& report)
        : options_(options), entries_(options.entries()), golden_(std::move(golden)), compared_(golden_.version == kTableVersion),
          report_(report),
          cache_({std::make_shared<const Jobs>(options.threads), options.isa, {options.use_cache, options.folder}, &watch_stop_signals()},
                 report)
    {
    }
    int run();

  private:
    Result<WalkedEntry> measure(const AtlasEntry& entry);
    std::vector<JobPiece> pieces();
    Status write_piece_of(const AtlasEntry& entry, const std::string& file, const std::string& key);
    Status take(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces); // into taken_
    void judge_entry(const AtlasEntry& entry, MeasuredEntry measured);
    void tell(const AtlasResult& result);
    std::string live_html();
    Status write();
    Status bless();

    const AtlasOptions& options_;
    const std::vector<AtlasEntry> entries_;
    GoldenTable golden_;
    bool compared_;
    Report& report_;
    PictureCache cache_;
    std::vector<AtlasResult> results_;
    std::map<std::string, MeasuredEntry> taken_; // from pieces, by id
};

Result<WalkedEntry> Atlas::measure(const AtlasEntry& entry)
{
    if (const auto taken = taken_.find(entry.id); taken != taken_.end())
        return WalkedEntry{std::move(taken->second), {}, false};
    if (options_.folder.empty())
        return walk_entry(entry, options_.walk(), cache_);
    const CachedFiles files = cached_files(options_, entry);
    if (std::optional<MeasuredEntry> cached = read_cached(files))
        return WalkedEntry{std::move(*cached), {}, false};
    Result<WalkedEntry> walked = walk_entry(entry, options_.walk(), cache_);
    if (!walked || walked->stopped)
        return walked;
    BN_TRY(write_image(files.strip, walked->strip));
    BN_TRY(write_file(files.json, cached_entry_json(walked->measured, files.key)));
    return walked;
}

// Walks an entry into a piece: its figures and its pictures.
Status Atlas::write_piece_of(const AtlasEntry& entry, const std::string& file, const std::string& key)
{
    const Result<WalkedEntry> walked = walk_entry(entry, options_.walk(), cache_);
    BN_TRY(walked);
    if (walked->stopped)
        return {};
    const std::string own = own_name_beside(file, ".png");
    BN_TRY(write_image(own, walked->strip));
    Result<std::vector<std::uint8_t>> strip = take_file(own);
    BN_TRY(strip);
    return write_piece(file, key,
                       pack({cached_entry_json(walked->measured, entry_key(entry, options_.walk())), {{"strip", std::move(*strip)}}}));
}

// Returns the entries as pieces. An estimate scales a quick walk of the first entry, by its samples.
std::vector<JobPiece> Atlas::pieces()
{
    const auto rate = std::make_shared<std::optional<double>>();
    std::vector<JobPiece> all;
    for (const AtlasEntry& entry : entries_) {
        const std::string key = piece_key("atlas " + entry_key(entry, options_.walk()));
        const auto seconds = [this, rate]() -> Result<double> {
            const auto size = [](const AtlasWalk& walk) {
                return static_cast<double>(walk.steps) * walk.side * walk.side * static_cast<double>(walk.samples);
            };
            if (!*rate) {
                const double begin = wall_ms();
                BN_TRY(walk_entry(entries_.front(), kQuickWalk, cache_));
                *rate = (wall_ms() - begin) * 1e-3 / size(kQuickWalk);
            }
            return **rate * size(options_.walk());
        };
        all.push_back({key, seconds, [this, &entry, key](const std::string& file) { return write_piece_of(entry, file, key); }});
    }
    return all;
}

Status Atlas::take(const std::vector<std::string>& files, const std::vector<JobPiece>& pieces)
{
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::vector<std::uint8_t>> content = read_piece(files[i], pieces[i].key);
        BN_TRY(content);
        const Result<Packed> packed = unpack(*content, files[i]);
        BN_TRY(packed);
        std::optional<MeasuredEntry> measured = parse_cached_entry(packed->json, entry_key(entries_[i], options_.walk()));
        if (!measured || packed->files.size() != 1)
            return Error{ExitCode::bad_input, files[i], "", "is a damaged piece"};
        if (!options_.folder.empty()) { // as a walk leaves them
            const CachedFiles cached = cached_files(options_, entries_[i]);
            BN_TRY(write_file_atomic(cached.strip, packed->files[0].bytes.data(), packed->files[0].bytes.size()));
            BN_TRY(write_file(cached.json, packed->json));
        }
        taken_.emplace(entries_[i].id, std::move(*measured));
    }
    return {};
}

void Atlas::judge_entry(const AtlasEntry& entry, MeasuredEntry measured)
{
    AtlasResult result{&entry, std::move(measured), {}, ""};
    const auto& rows = golden_.walks[options_.walk().name];
    const auto row = rows.find(entry.id);
    result.judged = judge(entry, result.measured, compared_ && row != rows.end() ? &row->second : nullptr);
    if (!options_.folder.empty())
        result.strip = fs::path(cached_files(options_, entry).strip).filename();
    results_.push_back(std::move(result));
}

void Atlas::tell(const AtlasResult& r)
{
    const MeasuredEntry& m = r.measured;
    report_.figures(fmt::format("{:<36} onset {:>5}  worst {:.4f}  flicker {:+.4f}  double {:>6}  cure {:>6}  {:<13} {}\n", m.id,
                                m.onset <= 1.0 ? fmt::format("{:.3f}", m.onset) : "none", m.worst, m.flicker,
                                m.in_double ? fmt::format("{:.4f}", *m.in_double) : "-",
                                r.entry->cure[0] ? fmt::format("{:.4f}", m.cure_worst) : "-", m.kind, verdict_name(r.judged.verdict)));
}

Status Atlas::bless()
{
    if (!compared_)
        golden_ = GoldenTable();
    for (const AtlasResult& r : results_)
        golden_.walks[options_.walk().name][r.entry->id] = row_of(r.measured);
    BN_TRY(write_text(options_.table, table_text(golden_)));
    report_.wrote(options_.table);
    return {};
}

// Returns the scripts that draw each entry's worst place anew in the page.
std::string Atlas::live_html()
{
    LiveWish wish;
    wish.renderer_folder = options_.renderer, wish.threads = options_.threads;
    SettingReader reader;
    for (const AtlasResult& r : results_) {
        const auto worst = std::max_element(r.measured.steps.begin(), r.measured.steps.end(),
                                            [](const AtlasStep& a, const AtlasStep& b) { return a.error < b.error; });
        if (worst == r.measured.steps.end() || !reader.read(*r.entry, AtlasRole::test, worst->s, options_.walk().side, 0))
            continue;
        if (std::optional<DrawRequest> request = live_request(reader.given()))
            wish.rows.push_back({r.entry->id, std::move(*request)});
    }
    const Result<LiveParts> parts = live_parts(wish);
    if (!parts)
        report_.warning("--live: " + parts.error().line());
    else if (const std::size_t left = results_.size() - wish.rows.size() + parts->left_out.size())
        report_.warning(
            fmt::format("--live: the page cannot draw {} of {} entries{}", left, results_.size(),
                        parts->left_out.empty() ? ": their options read a file" : ": " + parts->left_out.front().second.line()));
    return parts ? parts->html : "";
}

Status Atlas::write()
{
    const std::string json = json_text(atlas_json(results_, options_.walk()), 1) + "\n";
    std::vector<std::pair<std::string, std::string>> files;
    if (!options_.json.empty())
        files.emplace_back(options_.json, json);
    if (!options_.folder.empty()) {
        files.emplace_back(options_.folder + "/atlas.json", json);
        files.emplace_back(options_.folder + "/index.html", atlas_page(results_, options_.walk(), options_.live ? live_html() : ""));
    }
    for (const auto& [path, text] : files) {
        BN_TRY(write_text(path, text));
        report_.wrote(path);
    }
    return {};
}

int Atlas::run()
{
    if (!compared_)
        report_.warning(
            fmt::format("the golden figures are of version {}, not {}: nothing is compared with them", golden_.version, kTableVersion));
    if (any_pieces(options_.pieces)) {
        const std::vector<JobPiece> all = pieces();
        if (!options_.pieces.merge)
            return run_pieces(options_.pieces, command_words(), all, report_);
        const auto files = finished_pieces(options_.pieces, command_words(), all);
        if (!files)
            return fail(files.error());
        if (const Status made = options_.folder.empty() ? Status() : make_output_folder(options_.folder); !made)
            return fail(made.error());
        if (const Status taken = take(*files, all); !taken)
            return fail(taken.error());
    }
    report_.release();
    // Measure and judge every entry
    for (const AtlasEntry& entry : entries_) {
        const Activity activity(fmt::format("entry {} of {}: {}", results_.size() + 1, entries_.size(), entry.id));
        Result<WalkedEntry> walked = measure(entry);
        if (!walked)
            return fail(walked.error());
        if (walked->stopped) {
            report_.event("stopped", options_.folder.empty() ? "nothing was kept" : "the same command goes on; no page was written");
            return 128 + stop_signal();
        }
        judge_entry(entry, std::move(walked->measured));
        tell(results_.back());
    }
    // Write the pages, and bless if asked
    if (const Status written = write(); !written)
        return fail(written.error());
    if (options_.bless) {
        const Status blessed = bless();
        if (!blessed)
            return fail(blessed.error());
    }
    // Find the first entry that fails
    const AtlasResult* red = nullptr;
    for (const AtlasResult& r : results_) {
        if (options_.bless && r.judged.verdict != Verdict::uncured)
            continue;
        if (r.judged.verdict == Verdict::better)
            report_.warning(fmt::format("{} {}: it is better than its golden figures, bless it", r.entry->id, r.judged.why));
        if (!red && r.judged.verdict >= Verdict::worse)
            red = &r;
    }
    if (!red)
        return 0;
    const auto count =
        std::count_if(results_.begin(), results_.end(), [](const AtlasResult& r) { return r.judged.verdict >= Verdict::worse; });
    const std::string others = count > 1 ? fmt::format(" (and {} more)", count - 1) : "";
    return fail(Error{ExitCode::differ, red->entry->id, "", red->judged.why + others});
}

int run_atlas(AtlasOptions options, const OptionTable& given)
{
    if (const Status good = check_atlas_options(options, given); !good)
        return fail(good.error());
    if (options.list)
        return list_entries(options);
    if (options.live)
        if (const Status found = check_renderer(options.renderer); !found)
            return fail(found.error());
    Result<GoldenTable> golden = golden_table(options);
    if (!golden)
        return fail(golden.error());
    if (!options.folder.empty() && !any_pieces(options.pieces))
        if (const Status made = make_output_folder(options.folder); !made)
            return fail(made.error());
    if (!reference_available())
        return fail(Error{ExitCode::unavailable, "", "", "this program was built without Embree 3, which the reference of an atlas needs"});
    Report report(options.quiet, options.verbosity);
    report.promise_stdout({options.json});
    return Atlas(options, std::move(*golden), report).run();
}

} // namespace

Command atlas_command()
{
    auto options = std::make_shared<AtlasOptions>();
    return {"atlas", "Show and measure how each method fails, and compare with golden figures", atlas_option_table(*options), kFooter,
            [options](OptionTable& given) { return run_atlas(*options, given); }};
}

} // namespace burnish
