#include "apps/pieces/pieces.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "apps/cli/build.h"
#include "apps/cli/outputs.h"
#include "apps/cli/stop_signal.h"
#include "apps/cli/values.h"
#include "apps/pieces/lease.h"
#include "apps/pieces/share.h"
#include "apps/pieces/words.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/version.h"
#include "core/jobs/activity.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMostPieceBytes = std::uint64_t{1} << 34;
constexpr char kMagic[8] = {'B', 'N', 'P', 'I', 'E', 'C', 'E', '1'};
constexpr std::chrono::milliseconds kWait{500}, kLongestWait{8000}; // between two looks at other processes' pieces
constexpr const char* kDefaultFolder = "pieces";

std::string hex(std::uint64_t value)
{
    return fmt::format("{:016x}", value);
}

std::string hash_of(const std::string& text)
{
    return hex(hash_bytes(text.data(), text.size()));
}

std::string program_name()
{
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).filename();
}

std::string file_in(const std::string& folder, const std::string& key)
{
    return folder + "/" + key + ".piece";
}

// Keeps the command in the folder, for `burnish merge`: once for a list of pieces and its outputs. Errors: words that are not UTF-8.
Status write_job(const std::string& folder, const std::vector<std::string>& words, const std::vector<JobPiece>& pieces)
{
    std::string keys;
    for (const JobPiece& piece : pieces)
        keys += piece.key;
    keys += shell_words(job_words(words));
    const std::string file = fmt::format("{}/job-{}.json", folder, hash_of(keys));
    if (std::error_code ignored; fs::exists(file, ignored))
        return {};
    std::string text;
    try {
        const Json job = {{"burnish", version()}, {"program", program_name()}, {"build", hex(program_hash())}, {"words", job_words(words)}};
        text = job.dump(1) + "\n";
    } catch (const Json::type_error&) {
        return usage_error("", "pieces take no words that are not UTF-8");
    }
    return write_file_atomic(file, text.data(), text.size());
}

// Returns the command that makes one piece.
std::string command_of(const PieceOptions& options, const std::vector<std::string>& words, const std::string& key)
{
    std::vector<std::string> all = {"burnish"};
    const std::vector<std::string> bare = without_pieces(words);
    all.insert(all.end(), bare.begin(), bare.end());
    all.insert(all.end(), {"--piece", key, "--work", options.folders.empty() ? kDefaultFolder : options.folders.front()});
    return shell_words(all);
}

const std::string& process_name()
{
    static const std::string name = new_process_name();
    return name;
}

bool stopped()
{
    return watch_stop_signals().load();
}

// Returns true if the file has the head and the size of the piece. Reads the head alone: many processes ask for many pieces.
bool looks_whole(const std::string& file, const std::string& key)
{
    std::ifstream in(file, std::ios::binary);
    char magic[sizeof kMagic] = {};
    std::string made_by, own, hash, size;
    if (!in.read(magic, sizeof magic) || std::memcmp(magic, kMagic, sizeof kMagic) != 0 || !std::getline(in, made_by) ||
        !std::getline(in, own) || !std::getline(in, hash) || !std::getline(in, size))
        return false;
    std::error_code failed;
    const std::uintmax_t all = fs::file_size(file, failed), head = static_cast<std::uintmax_t>(in.tellg());
    return !failed && made_by == version() && own == key && size == std::to_string(all - head);
}

// Makes pieces in a folder. deep: reads pieces that are there to their end; else a flipped bit waits for the merge.
class Maker {
  public:
    Maker(std::string folder, const std::vector<JobPiece>& pieces, bool deep, Report& report)
        : folder_(std::move(folder)), pieces_(pieces), deep_(deep), report_(report)
    {
    }

    std::string file(std::size_t i) const { return file_in(folder_, pieces_[i].key); }

    bool whole(std::size_t i)
    {
        if (!whole_.count(i) && looks_whole(file(i), pieces_[i].key) && (!deep_ || read_piece(file(i), pieces_[i].key)))
            whole_.insert(i);
        return whole_.count(i) > 0;
    }

    // A failure does not count where another process made the piece meanwhile.
    Status make(std::size_t i)
    {
        const Activity activity(fmt::format("piece {} of {}", i + 1, pieces_.size()));
        if (whole(i))
            return {};
        const Status made = pieces_[i].make(file(i));
        if (!made && !whole(i))
            return made;
        if (!stopped())
            report_.wrote(file(i));
        return {};
    }

  private:
    std::string folder_;
    const std::vector<JobPiece>& pieces_;
    bool deep_;
    Report& report_;
    std::set<std::size_t> whole_;
};

// Returns the names in a folder: one request for many pieces.
std::set<std::string> names_in(const std::string& folder)
{
    std::set<std::string> names;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        names.insert(at->path().filename());
    return names;
}

// Takes pieces by lease until all are there. A folder's server answers a limited number of requests, so a look at the folder shows the
// pieces left, and each process begins elsewhere. Only pieces that are there at first are looked at one by one.
class Taker {
  public:
    Taker(const std::string& folder, const std::vector<JobPiece>& pieces, Maker& maker)
        : folder_(folder), pieces_(pieces), maker_(maker), leases_(process_name()), missing_(pieces.size(), true),
          first_(hash_bytes(process_name().data(), process_name().size()) % std::max<std::size_t>(pieces.size(), 1))
    {
        const std::set<std::string> names = names_in(folder_);
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            missing_[i] = !names.count(pieces_[i].key + ".piece") || !maker_.whole(i);
        seen_ = names;
    }

    Status run()
    {
        std::chrono::milliseconds wait = kWait;
        while (!stopped()) {
            const std::set<std::string> names = names_in(folder_);
            note_finished(names);
            std::vector<std::size_t> free, held; // without and with a lease
            for (std::size_t k = 0; k < pieces_.size(); ++k)
                if (const std::size_t i = (first_ + k) % pieces_.size(); missing_[i])
                    (names.count(pieces_[i].key + ".piece.lease") ? held : free).push_back(i);
            if (free.empty() && held.empty())
                return {};
            // Take one without a lease, or one whose owner died
            const Result<bool> made = take_one(free.empty() ? held : free);
            BN_TRY(made);
            if (*made) {
                wait = kWait;
                continue;
            }
            const Activity activity("waiting for pieces of other processes");
            std::this_thread::sleep_for(free.empty() ? wait : std::chrono::milliseconds(0));
            wait = std::min(2 * wait, kLongestWait);
        }
        return {};
    }

  private:
    // A piece that was damaged at first is not finished before its name comes anew.
    void note_finished(const std::set<std::string>& names)
    {
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            if (const std::string name = pieces_[i].key + ".piece";
                missing_[i] && names.count(name) && (!seen_.count(name) || maker_.whole(i)))
                missing_[i] = false;
    }

    // Makes the first piece of these whose lease this process gets. Returns false where it gets none.
    Result<bool> take_one(const std::vector<std::size_t>& candidates)
    {
        for (const std::size_t i : candidates) {
            const Result<std::unique_ptr<Lease>> lease = leases_.take(maker_.file(i) + ".lease");
            BN_TRY(lease);
            if (!*lease)
                continue;
            BN_TRY(maker_.make(i));
            missing_[i] = stopped();
            return true;
        }
        return false;
    }

    const std::string& folder_;
    const std::vector<JobPiece>& pieces_;
    Maker& maker_;
    Leases leases_;
    std::vector<bool> missing_;
    std::size_t first_;
    std::set<std::string> seen_; // at first
};

// Returns the pieces that one process makes by --piece or --shard, by number.
Result<std::vector<std::size_t>> share_of_pieces(const PieceOptions& options, const std::vector<JobPiece>& pieces)
{
    std::vector<std::size_t> share;
    if (!options.piece.empty()) {
        const auto at = std::find_if(pieces.begin(), pieces.end(), [&](const JobPiece& p) { return p.key == options.piece; });
        if (at == pieces.end())
            return usage_error("--piece", fmt::format("'{}' is no piece of this command; --pieces lists them", options.piece));
        share.push_back(static_cast<std::size_t>(at - pieces.begin()));
    } else if (!options.shard.empty()) {
        const Result<Share> asked = parse_share(options.shard);
        BN_TRY(asked);
        for (std::size_t i = 0; i < pieces.size(); ++i)
            if (asked->holds(i))
                share.push_back(i);
    }
    return share;
}

Status make_pieces(const PieceOptions& options, const std::string& folder, const std::vector<std::string>& words,
                   const std::vector<JobPiece>& pieces, Report& report)
{
    const Result<std::vector<std::size_t>> share = share_of_pieces(options, pieces);
    BN_TRY(share);
    BN_TRY(make_output_folder(folder));
    BN_TRY(write_job(folder, words, pieces));
    report.release();
    Maker maker(folder, pieces, !options.piece.empty(), report);
    if (options.take)
        return Taker(folder, pieces, maker).run();
    for (const std::size_t i : *share)
        if (!stopped())
            BN_TRY(maker.make(i));
    return {};
}

Status list_pieces(const PieceOptions& options, const std::vector<std::string>& words, const std::vector<JobPiece>& pieces)
{
    std::string lines;
    for (const JobPiece& piece : pieces) {
        const Result<double> seconds = piece.seconds();
        BN_TRY(seconds);
        lines += fmt::format("{} {:.3g} {}\n", piece.key, *seconds, command_of(options, words, piece.key));
    }
    std::fputs(lines.c_str(), stdout);
    return {};
}

// Removes the files beside finished pieces: leases, and files in the making of processes that died.
void sweep(const std::vector<std::string>& folders, const std::vector<JobPiece>& pieces)
{
    std::set<std::string> keys;
    for (const JobPiece& piece : pieces)
        keys.insert(piece.key);
    for (const std::string& folder : folders) {
        std::vector<fs::path> left;
        std::error_code failed, ignored;
        for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
            if (const std::string name = at->path().filename(); name.find(".piece.") != std::string::npos && keys.count(name.substr(0, 16)))
                left.push_back(at->path());
        for (const fs::path& path : left)
            fs::remove_all(path, ignored); // files that stay do no harm
    }
}

// Reads one job file.
Result<std::vector<std::string>> read_job(const std::string& file)
{
    const auto refuse = [&](const std::string& reason) { return Error{ExitCode::bad_input, file, "", reason}; };
    const Result<std::vector<std::uint8_t>> bytes = read_file(file, 1u << 20);
    BN_TRY(bytes);
    const Json job = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
    const auto text = [&](const char* name) { return job.contains(name) && job[name].is_string() ? job[name].get<std::string>() : ""; };
    const bool whole = job.is_object() && !text("burnish").empty() && job.contains("words") && job["words"].is_array() &&
                       !job["words"].empty() &&
                       std::all_of(job["words"].begin(), job["words"].end(), [](const Json& w) { return w.is_string(); });
    if (!whole)
        return refuse("is not a job");
    if (text("burnish") != version())
        return refuse(fmt::format("was made by burnish {}, and this is {}", text("burnish"), version()));
    if (text("program") == program_name() && text("build") != hex(program_hash())) // burnish-lab judges its own
        return refuse(fmt::format("was made by another build of burnish {}", version()));
    return job["words"].get<std::vector<std::string>>();
}

} // namespace

std::vector<Option> piece_options(PieceOptions& to)
{
    return {
        {"--pieces", "", "List the pieces of the job: key, estimated seconds, command", flag(to.list)},
        {"--shard", "I/N", "Make every N-th piece, from the I-th; auto: as the engine's environment says; auto/N: its index, of N",
         text(to.shard)},
        {"--take", "", "Take pieces that no other process has, until all are there", flag(to.take)},
        {"--piece", "KEY", "Make one piece", text(to.piece)},
        {"--merge", "", "Put the pieces together, and write the command's files", flag(to.merge)},
        {"--work", "DIR", "Folder of the pieces, shared by all processes; may be repeated for --merge", texts(to.folders), kDefaultFolder}};
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
    if (!o.shard.empty())
        BN_TRY(parse_share(o.shard));
    return {};
}

std::string piece_key(const std::string& text)
{
    return hash_of(fmt::format("{} {:016x}\n{}", version(), program_hash(), text));
}

std::string own_name_beside(const std::string& file, const std::string& extension)
{
    return file + "." + hash_of(process_name()) + extension;
}

int run_pieces(const PieceOptions& options, const std::vector<std::string>& words, const std::vector<JobPiece>& pieces, Report& report)
{
    const std::string folder = options.folders.empty() ? kDefaultFolder : options.folders.front();
    const Status done = options.list ? list_pieces(options, words, pieces) : make_pieces(options, folder, words, pieces, report);
    if (!done)
        return fail(done.error());
    return stopped() ? 128 + stop_signal() : 0; // as a shell reports a process ended by a signal
}

namespace {

bool holds_pieces(const std::string& folder)
{
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        if (at->path().extension() == ".piece")
            return true;
    return false;
}

} // namespace

Result<std::vector<std::string>> finished_pieces(const PieceOptions& options, const std::vector<std::string>& words,
                                                 const std::vector<JobPiece>& pieces)
{
    const std::vector<std::string> folders = options.folders.empty() ? std::vector<std::string>{kDefaultFolder} : options.folders;
    std::vector<std::string> files;
    std::string missing, refused; // commands; why a piece that is there does not count
    std::size_t absent = 0;
    for (const JobPiece& piece : pieces) {
        bool found = false;
        for (auto folder = folders.begin(); folder != folders.end() && !found; ++folder) {
            const std::string file = file_in(*folder, piece.key);
            if (std::error_code ignored; !fs::exists(file, ignored))
                continue;
            const Result<std::vector<std::uint8_t>> content = read_piece(file, piece.key);
            if (found = static_cast<bool>(content); found)
                files.push_back(file);
            else if (refused.empty())
                refused = " (" + content.error().line() + ")";
        }
        if (!found)
            missing += command_of(options, words, piece.key) + "\n", ++absent;
    }
    if (!absent) {
        sweep(folders, pieces);
        return files;
    }
    std::fputs(missing.c_str(), stdout);
    if (absent == pieces.size() && refused.empty() && std::any_of(folders.begin(), folders.end(), holds_pieces))
        refused = " (those that are there are of another scene, job or program)";
    return Error{ExitCode::golden_missing, join(folders), "",
                 fmt::format("{} of {} pieces are missing{}; standard output has their commands", absent, pieces.size(), refused)};
}

Status write_piece(const std::string& file, const std::string& key, const std::vector<std::uint8_t>& content)
{
    const std::string head =
        fmt::format("{}\n{}\n{}\n{}\n", version(), key, hex(hash_bytes(content.data(), content.size())), content.size());
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
    const std::string made_by = line(), own = line(), hash = line(), size = line();
    if (made_by != version())
        return refuse(fmt::format("was made by burnish {}, and this is {}", made_by, version()));
    if (own != key)
        return refuse(fmt::format("is piece {}", own));
    std::vector<std::uint8_t> content(at, bytes->end());
    if (std::to_string(content.size()) != size || hex(hash_bytes(content.data(), content.size())) != hash)
        return refuse("is damaged");
    return content;
}

Result<std::vector<std::string>> job_of(const std::vector<std::string>& folders)
{
    std::set<std::string> names; // of equal jobs in several folders, one
    std::vector<std::string> files;
    for (const std::string& folder : folders) {
        std::error_code failed;
        for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
            if (const std::string name = at->path().filename();
                name.starts_with("job-") && name.ends_with(".json") && names.insert(name).second)
                files.push_back(at->path());
        if (failed)
            return Error{ExitCode::bad_input, folder, "", failed.message()};
    }
    const auto refuse = [&](const std::string& reason) { return Error{ExitCode::bad_input, join(folders), "", reason}; };
    if (files.empty())
        return refuse("holds no job; --shard, --take and --piece write one");
    std::sort(files.begin(), files.end());
    std::vector<std::vector<std::string>> commands;
    for (const std::string& file : files) {
        Result<std::vector<std::string>> words = read_job(file);
        BN_TRY(words);
        if (std::find(commands.begin(), commands.end(), *words) == commands.end()) // one of changed files has other pieces
            commands.push_back(std::move(*words));
    }
    if (commands.size() == 1)
        return commands.front();
    std::string all;
    for (const std::vector<std::string>& words : commands) {
        all += "burnish " + shell_words(words) + " --merge";
        for (const std::string& folder : folders)
            all += " --work " + shell_words({folder});
        all += "\n";
    }
    std::fputs(all.c_str(), stdout);
    return refuse("holds pieces of several jobs; standard output has a command that merges each");
}

} // namespace burnish
