#include "apps/pieces/pieces.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/cli/outputs.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/pieces/lease.h"
#include "apps/pieces/share.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/version.h"
#include "core/jobs/activity.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostPieceBytes = std::uint64_t{1} << 34;
constexpr char kMagic[8] = {'B', 'N', 'P', 'I', 'E', 'C', 'E', '1'};
constexpr std::chrono::milliseconds kWait{500}; // between two looks at other processes' pieces

std::string hex(std::uint64_t value)
{
    return fmt::format("{:016x}", value);
}

std::string file_in(const std::string& folder, const std::string& key)
{
    return folder + "/" + key + ".piece";
}

bool exists(const std::string& file)
{
    std::error_code ignored;
    return fs::exists(file, ignored);
}

// An option that changes no file of a job, and whether a value follows.
struct PieceWord {
    const char* name;
    bool takes_value;
};
constexpr PieceWord kPieceWords[] = {{"--pieces", false}, {"--piece", true},  {"--shard", true},
                                     {"--take", false},   {"--merge", false}, {"--work", true}};
constexpr PieceWord kMachineWords[] = {{"--quiet", false}, {"--verbose", false}, {"--threads", true}, {"-t", true}, {"--isa", true}};

// True for the letters q and v in one word, with t and its number behind them.
bool says_how_much(const std::string& word)
{
    const std::size_t rest = word.size() > 1 && word[0] == '-' ? word.find_first_not_of("qv", 1) : 0;
    return rest == std::string::npos ||
           (rest > 0 && word[rest] == 't' && rest + 1 < word.size() && word.find_first_not_of("0123456789", rest + 1) == std::string::npos);
}

template <std::size_t N> std::vector<std::string> without(const PieceWord (&dropped)[N], const std::vector<std::string>& words)
{
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string name = words[i].substr(0, words[i].find('='));
        const auto* const found = std::find_if(std::begin(dropped), std::end(dropped), [&](const PieceWord& w) { return name == w.name; });
        if (found == std::end(dropped))
            kept.push_back(words[i]);
        else if (found->takes_value && words[i] == name)
            ++i;
    }
    return kept;
}

std::string job_text(const std::vector<std::string>& words)
{
    return nlohmann::json({{"burnish", version()}, {"words", words}}).dump(1) + "\n";
}

// Keeps the command in the folder, for `burnish merge`.
Status write_job(const std::string& folder, const std::vector<std::string>& words)
{
    const std::string text = job_text(words), file = fmt::format("{}/job-{}.json", folder, hex(hash_bytes(text.data(), text.size())));
    return exists(file) ? Status() : write_file_atomic(file, text.data(), text.size());
}

// Returns the command that makes one piece.
std::string command_of(const PieceOptions& options, const std::vector<std::string>& words, const std::string& key)
{
    std::vector<std::string> all = {"burnish"};
    const std::vector<std::string> bare = without_pieces(words);
    all.insert(all.end(), bare.begin(), bare.end());
    all.insert(all.end(), {"--piece", key, "--work", options.folders.empty() ? "pieces" : options.folders.front()});
    return shell_words(all);
}

bool stopped()
{
    return watch_stop_signals().load();
}

Status make_piece(const JobPiece& piece, const std::string& folder, std::size_t at, std::size_t count, Report& report)
{
    const Activity activity(fmt::format("piece {} of {}", at + 1, count));
    const std::string file = file_in(folder, piece.key);
    if (exists(file))
        return {};
    BN_TRY(piece.make(file));
    if (!stopped())
        report.wrote(file);
    return {};
}

// Takes pieces by lease until all are there.
Status take_pieces(const std::string& folder, const std::vector<JobPiece>& pieces, Report& report)
{
    Leases leases;
    bool waited = true;
    while (waited && !stopped()) {
        waited = false;
        for (std::size_t i = 0; i < pieces.size() && !stopped(); ++i) {
            const std::string file = file_in(folder, pieces[i].key);
            if (exists(file))
                continue;
            const Result<std::unique_ptr<Lease>> lease = leases.take(file + ".lease");
            BN_TRY(lease);
            waited = waited || !*lease;
            if (*lease)
                BN_TRY(make_piece(pieces[i], folder, i, pieces.size(), report));
        }
        if (waited) {
            const Activity activity("waiting for pieces of other processes");
            std::this_thread::sleep_for(kWait);
        }
    }
    return {};
}

Status make_share(const PieceOptions& options, const std::vector<JobPiece>& pieces, Report& report)
{
    const std::string& folder = options.folders.front();
    if (options.take)
        return take_pieces(folder, pieces, report);
    if (!options.piece.empty()) {
        const auto at = std::find_if(pieces.begin(), pieces.end(), [&](const JobPiece& p) { return p.key == options.piece; });
        if (at == pieces.end())
            return usage_error("--piece", fmt::format("'{}' is no piece of this command; --pieces lists them", options.piece));
        return make_piece(*at, folder, static_cast<std::size_t>(at - pieces.begin()), pieces.size(), report);
    }
    const Result<Share> share = parse_share(options.shard);
    BN_TRY(share);
    for (std::size_t i = 0; i < pieces.size() && !stopped(); ++i)
        if (share->holds(i))
            BN_TRY(make_piece(pieces[i], folder, i, pieces.size(), report));
    return {};
}

} // namespace

std::vector<Option> piece_options(PieceOptions& to)
{
    return {{"--pieces", "", "List the pieces of the job: key, estimated seconds, command", flag(to.list)},
            {"--shard", "I/N", "Make every N-th piece, from the I-th; auto: as the engine's environment says; auto/N: its index, of N",
             text(to.shard)},
            {"--take", "", "Take pieces that no other process has, until all are there", flag(to.take)},
            {"--piece", "KEY", "Make one piece", text(to.piece)},
            {"--merge", "", "Put the pieces together, and write the command's files", flag(to.merge)},
            {"--work", "DIR", "Folder of the pieces, shared by all processes; may be repeated for --merge", texts(to.folders), "pieces"}};
}

bool any_pieces(const PieceOptions& o)
{
    return o.list || o.take || o.merge || !o.shard.empty() || !o.piece.empty();
}

Status check_piece_options(const PieceOptions& o)
{
    const int asked = o.list + o.take + o.merge + !o.shard.empty() + !o.piece.empty();
    if (!asked && !o.folders.empty())
        return usage_error("--work", "needs --pieces, --shard, --take, --piece or --merge");
    if (asked > 1)
        return usage_error(o.list    ? "--pieces"
                           : o.merge ? "--merge"
                           : o.take  ? "--take"
                                     : "--piece",
                           "cannot be combined with another of --pieces, --shard, --take, --piece and --merge");
    if (o.folders.size() > 1 && !o.merge)
        return usage_error("--work", "may be repeated for --merge only");
    if (!o.shard.empty()) {
        const Result<Share> share = parse_share(o.shard);
        BN_TRY(share);
    }
    return {};
}

std::string piece_key(const std::string& text)
{
    const std::string all = std::string(version()) + "\n" + text;
    return hex(hash_bytes(all.data(), all.size()));
}

int run_pieces(const PieceOptions& options, const std::vector<std::string>& words, const std::vector<JobPiece>& pieces, Report& report)
{
    if (options.list) {
        std::string lines;
        for (const JobPiece& piece : pieces)
            lines += fmt::format("{} {:.3g} {}\n", piece.key, piece.seconds(), command_of(options, words, piece.key));
        std::fputs(lines.c_str(), stdout);
        return 0;
    }
    report.release();
    PieceOptions placed = options;
    if (placed.folders.empty())
        placed.folders = {"pieces"};
    for (const Status& done : {make_output_folder(placed.folders.front()), write_job(placed.folders.front(), job_words(words))})
        if (!done)
            return fail(done.error());
    if (const Status made = make_share(placed, pieces, report); !made)
        return fail(made.error());
    return stopped() ? 128 + stop_signal() : 0; // as a shell reports a process ended by a signal
}

Result<std::vector<std::string>> finished_pieces(const PieceOptions& options, const std::vector<std::string>& words,
                                                 const std::vector<JobPiece>& pieces)
{
    const std::vector<std::string> folders = options.folders.empty() ? std::vector<std::string>{"pieces"} : options.folders;
    std::vector<std::string> files;
    std::string missing, refused; // commands; why a piece that is there does not count
    std::size_t absent = 0;
    for (const JobPiece& piece : pieces) {
        const auto at = std::find_if(folders.begin(), folders.end(), [&](const std::string& f) { return exists(file_in(f, piece.key)); });
        if (at != folders.end()) {
            files.push_back(file_in(*at, piece.key));
            const Result<std::vector<std::uint8_t>> content = read_piece(files.back(), piece.key);
            if (content)
                continue;
            if (refused.empty())
                refused = " (" + content.error().line() + ")";
        }
        missing += command_of(options, words, piece.key) + "\n";
        ++absent;
    }
    if (!absent)
        return files;
    std::fputs(missing.c_str(), stdout);
    return Error{ExitCode::golden_missing, join(folders), "",
                 fmt::format("{} of {} pieces are missing{}; standard output has their commands", absent, pieces.size(), refused)};
}

Status write_piece(const std::string& file, const std::string& key, const std::vector<std::uint8_t>& content)
{
    const std::string head = std::string(version()) + "\n" + key + "\n" + hex(hash_bytes(content.data(), content.size())) + "\n";
    return write_file_atomic(file, [&](const PutBytes& put) {
        if (put(kMagic, sizeof kMagic) && put(head.data(), head.size()))
            put(content.data(), content.size());
    });
}

Result<std::vector<std::uint8_t>> read_piece(const std::string& file, const std::string& key)
{
    const auto refuse = [&](const std::string& reason) { return Error{ExitCode::bad_input, file, "", reason}; };
    Result<std::vector<std::uint8_t>> bytes = read_file(file, kMostPieceBytes);
    BN_TRY(bytes);
    auto at = bytes->begin();
    if (bytes->size() < sizeof kMagic || std::memcmp(bytes->data(), kMagic, sizeof kMagic) != 0)
        return refuse("is not a piece of a job");
    at += sizeof kMagic;
    const auto line = [&] {
        const auto end = std::find(at, bytes->end(), '\n');
        std::string text(at, end);
        at = end == bytes->end() ? end : end + 1;
        return text;
    };
    const std::string made_by = line(), own = line(), hash = line();
    if (made_by != version())
        return refuse(fmt::format("was made by burnish {}, and this is {}", made_by, version()));
    if (own != key)
        return refuse(fmt::format("is piece {}", own));
    std::vector<std::uint8_t> content(at, bytes->end());
    if (hex(hash_bytes(content.data(), content.size())) != hash)
        return refuse("is damaged");
    return content;
}

std::string shell_words(const std::vector<std::string>& words)
{
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:@%";
    std::string line;
    for (const std::string& word : words) {
        line += line.empty() ? "" : " ";
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            line += word;
            continue;
        }
        line += "'";
        for (const char c : word)
            line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += "'";
    }
    return line;
}

std::vector<std::string> without_pieces(const std::vector<std::string>& words)
{
    return without(kPieceWords, words);
}

std::vector<std::string> job_words(const std::vector<std::string>& words)
{
    std::vector<std::string> kept = without(kMachineWords, without_pieces(words));
    std::erase_if(kept, says_how_much);
    return kept;
}

Result<std::vector<std::string>> job_of(const std::string& folder)
{
    const auto refuse = [&](const std::string& reason) { return Error{ExitCode::bad_input, folder, "", reason}; };
    std::vector<std::string> jobs;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (const std::string name = at->path().filename(); name.starts_with("job-") && name.ends_with(".json"))
            jobs.push_back(at->path());
    if (failed)
        return refuse(failed.message());
    if (jobs.empty())
        return refuse("holds no job; --shard, --take and --piece write one");
    std::sort(jobs.begin(), jobs.end());
    std::vector<std::vector<std::string>> commands;
    for (const std::string& file : jobs) {
        const Result<std::vector<std::uint8_t>> bytes = read_file(file, 1u << 20);
        BN_TRY(bytes);
        const nlohmann::json job = nlohmann::json::parse(bytes->begin(), bytes->end(), nullptr, false);
        const bool whole = job.is_object() && job.contains("burnish") && job["burnish"].is_string() && job.contains("words") &&
                           job["words"].is_array() && !job["words"].empty() &&
                           std::all_of(job["words"].begin(), job["words"].end(), [](const nlohmann::json& w) { return w.is_string(); });
        if (!whole)
            return Error{ExitCode::bad_input, file, "", "is not a job"};
        if (job["burnish"] != version())
            return Error{ExitCode::bad_input, file, "",
                         fmt::format("was made by burnish {}, and this is {}", job["burnish"].get<std::string>(), version())};
        commands.push_back(job["words"].get<std::vector<std::string>>());
    }
    if (commands.size() == 1)
        return commands.front();
    std::string all;
    for (const std::vector<std::string>& words : commands)
        all += "burnish " + shell_words(words) + " --merge --work " + shell_words({folder}) + "\n";
    std::fputs(all.c_str(), stdout);
    return refuse("holds pieces of several jobs; standard output has a command that merges each");
}

} // namespace burnish
