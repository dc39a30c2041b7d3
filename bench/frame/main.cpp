// Prints the table of renderer speed. Draws workloads at 1920x1080 in turn. The headline is a frame's CPU time, with
// wall time beside it. Compares with the aims where the machine is quiet enough. bench_frame --help lists the options.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

#include "bench/frame/run.h"
#include "core/base/file.h"
#include "core/base/result.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr const char* kHelp = R"(usage: bench_frame [options]
  --only NAME     groups or workloads whose name holds NAME (--list names them)
  --quick         3 rounds, without the largest workloads
  --rounds N      of every workload, in turn with the others of its group (11)
  --isa LIST      scalar, avx2, avx512; several, comma separated, one after another (the best one)
  --threads N     of workloads that name none (all cores)
  --json FILE     all figures
  --program FILE  burnish, for the time to the first pixel (beside this program's folder)
  --list          the workloads
)";

struct Options {
    RunOptions run;
    std::vector<Isa> isas = {best_isa()};
    std::string json;
    std::int64_t memory_of = 0;
    bool list = false, help = false;
};

Error wrong(const std::string& option, const std::string& reason)
{
    return {ExitCode::usage, "", option, reason};
}

Result<std::vector<Isa>> parse_isas(const std::string& list)
{
    std::vector<Isa> isas;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const Result<Isa> isa = parse_isa(list.substr(begin, end - begin));
        if (!isa)
            return wrong("--isa", isa.error().reason);
        if (!isa_available(*isa))
            return Error{ExitCode::unavailable, "", "--isa", std::string(isa_name(*isa)) + " is not available on this machine"};
        isas.push_back(*isa);
        begin = end + 1;
    }
    return isas;
}

Result<Options> parse(int argc, char** argv)
{
    Options o;
    std::error_code ignored;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
    o.run.self = self.string();
    o.run.program = (self.parent_path() / "burnish").string(); // both are in the build folder
    bool rounds_given = false;
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        const auto flag = [&](const char* name, bool& to) { return option == name && (to = true); };
        if (flag("--quick", o.run.quick) || flag("--list", o.list) || flag("--help", o.help))
            continue;
        if (i + 1 == argc)
            return wrong(option, "is not an option, or its value is missing");
        const std::string value = argv[++i];
        const std::int64_t number = std::strtoll(value.c_str(), nullptr, 10);
        if (option == "--only")
            o.run.only = value;
        else if (option == "--json")
            o.json = value;
        else if (option == "--program")
            o.run.program = value;
        else if (option == "--memory-of")
            o.memory_of = number;
        else if (option == "--rounds" && number >= 1 && number <= 1000)
            o.run.rounds = static_cast<int>(number), rounds_given = true;
        else if (option == "--threads" && number >= 0 && number <= 1024)
            o.run.subject.threads = static_cast<int>(number);
        else if (option == "--isa") {
            Result<std::vector<Isa>> isas = parse_isas(value);
            BN_TRY(isas);
            o.isas = *isas;
        } else
            return wrong(option, "'" + value + "': no such option, or not a value of it");
    }
    if (o.run.quick && !rounds_given)
        o.run.rounds = 3;
    return o;
}

nlohmann::ordered_json json_of(const Spread& s)
{
    return {{"median", s.median}, {"low", s.low}, {"high", s.high}};
}

nlohmann::ordered_json workloads_json(const std::vector<Measured>& all, Isa isa)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Measured& m : all)
        list.push_back({{"name", m.workload->name},
                        {"isa", isa_name(isa)},
                        {"width", m.workload->width},
                        {"height", m.workload->height},
                        {"msaa", m.workload->msaa},
                        {"group", m.workload->group},
                        {"along", m.workload->along},
                        {"units", m.units},
                        {"pixels", m.pixels},
                        {"load_average", m.load},
                        {"cpu_ms", json_of(spread_of(m.cpu_ms))},
                        {"wall_ms", json_of(spread_of(m.wall_ms))},
                        {"cpu_ms_rounds", m.cpu_ms},
                        {"wall_ms_rounds", m.wall_ms}});
    return list;
}

// Returns the rows as JSON. `headline`: the machine was quiet enough for a judgement.
nlohmann::ordered_json rows_json(const std::vector<Row>& rows, Isa isa, bool headline)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& r : rows)
        list.push_back({{"group", r.group},
                        {"what", r.what},
                        {"isa", isa_name(isa)},
                        {"unit", r.unit},
                        {"aim", r.aim ? nlohmann::ordered_json(*r.aim) : nlohmann::ordered_json()},
                        {"bound", r.at_least ? "at least" : "at most"},
                        {"measured", json_of(r.value)},
                        {"met", r.aim && headline ? nlohmann::ordered_json(r.met()) : nlohmann::ordered_json()},
                        {"note", r.note}});
    return list;
}

void print_rows(const std::vector<Row>& rows, Isa isa, bool headline)
{
    fmt::print("| {:<54} | {:>10} | {:>9} | {:<17} | {:<6} | {}\n", isa_name(isa), "aim", "measured", "quartiles", "", "beside it");
    fmt::print("| {:-<54} | {:->10} | {:->9} | {:-<17} | {:-<6} | {:-<9}\n", "", "", "", "", "", "");
    for (const Row& r : rows)
        fmt::print("| {:<54} | {:>10} | {:>9} | {:<17} | {:<6} | {}\n", r.what,
                   r.aim ? fmt::format("{} {:.3g} {}", r.at_least ? ">=" : "<=", *r.aim, r.unit) : "",
                   fmt::format("{:.4g} {}", r.value.median, r.unit), fmt::format("{:.4g} to {:.4g}", r.value.low, r.value.high),
                   !r.aim      ? ""
                   : !headline ? "busy"
                   : r.met()   ? "met"
                               : "missed",
                   r.note);
}

void print_workloads(const std::vector<Measured>& all)
{
    fmt::print("\n{:<26} {:>9} {:>19} {:>9} {:>19} {:>6}\n", "workload", "CPU ms", "quartiles", "wall ms", "quartiles", "load");
    for (const Measured& m : all) {
        const Spread cpu = spread_of(m.cpu_ms), wall = spread_of(m.wall_ms);
        fmt::print("{:<26} {:>9.2f} {:>8.2f} to {:>7.2f} {:>9.2f} {:>8.2f} to {:>7.2f} {:>6.2f}\n", m.workload->name, cpu.median, cpu.low,
                   cpu.high, wall.median, wall.low, wall.high, m.load);
    }
}

void say(const std::string& line)
{
    fmt::print(stderr, "{}\n", line);
}

int fail(const Error& error)
{
    fmt::print(stderr, "bench_frame: {}\n", error.line());
    return static_cast<int>(error.code);
}

Status write_json(const std::string& path, const nlohmann::ordered_json& json)
{
    const std::string text = json.dump(1) + "\n";
    return write_file_atomic(path, text.data(), text.size());
}

template <class Make> Status append(std::vector<Row>& rows, const RunOptions& run, const char* group, const char* how, Make make)
{
    if (!chosen(run, group, group))
        return {};
    say(std::string(group) + ": " + how);
    Result<std::vector<Row>> more = make(run);
    BN_TRY(more);
    rows.insert(rows.end(), more->begin(), more->end());
    return {};
}

int run(const Options& options)
{
    // Describe the machine and its load
    nlohmann::ordered_json json;
    json["machine"] = machine_json();
    json["threads"] = Jobs(options.run.subject.threads).threads();
    json["rounds"] = options.run.rounds;
    json["rows"] = json["workloads"] = nlohmann::ordered_json::array();
    fmt::print("{}, {} threads, version {}, {}, load average {:.2f}\n", json["machine"]["processor"].get<std::string>(),
               json["threads"].get<int>(), json["machine"]["version"].get<std::string>(), json["machine"]["compiler"].get<std::string>(),
               load_average());
    const Quiet quiet = how_quiet();
    const bool headline = quiet.headline();
    json["clock_ghz"] = quiet.clock_ghz, json["waited"] = quiet.waited, json["headline"] = headline;
    fmt::print("effective clock {:.2f} GHz, a thread waits {:.1f} % of its time{}\n", quiet.clock_ghz, 100.0 * quiet.waited,
               headline ? "" : ": too busy to judge by, compare ratios only");
    // Run the workloads on each instruction set, and print the rows
    for (const Isa isa : options.isas) {
        RunOptions run = options.run;
        run.subject.isa = isa;
        const Result<std::vector<Measured>> measured = run_workloads(run, say);
        if (!measured)
            return fail(measured.error());
        std::vector<Row> rows = rows_of(*measured);
        for (Row& row : rows)
            if (row.group == "rays")
                row.note += fmt::format("; {:.3f} % of the pixels see the same triangle", 100.0 * agreement_with_rays(run));
        if (const Status done = append(rows, run, "accuracy", "against the reference", accuracy_rows); !done)
            return fail(done.error());
        if (const Status done = append(rows, run, "memory", "processes of their own", memory_rows); !done)
            return fail(done.error());
        if (const Status done = append(rows, run, "first_pixel", "processes of their own", first_pixel_rows); !done)
            return fail(done.error());
        print_rows(rows, isa, headline);
        print_workloads(*measured);
        for (const auto& row : rows_json(rows, isa, headline))
            json["rows"].push_back(row);
        for (const auto& workload : workloads_json(*measured, isa))
            json["workloads"].push_back(workload);
    }
    // Write the JSON file
    json["load_average_end"] = load_average();
    if (options.json.empty())
        return 0;
    const Status written = write_json(options.json, json);
    return written ? 0 : fail(written.error());
}

} // namespace
} // namespace burnish

int main(int argc, char** argv)
{
    using namespace burnish;
    const Result<Options> options = parse(argc, argv);
    if (!options)
        return fail(options.error());
    if (options->help)
        return std::fputs(kHelp, stdout) < 0;
    if (options->list) {
        for (const Workload& w : workloads())
            fmt::print("{:<16} {}\n", w.group, w.name);
        return 0;
    }
    if (options->memory_of > 0) {
        SubjectOptions subject = options->run.subject;
        subject.isa = options->isas.front();
        return print_memory_of(options->memory_of, subject);
    }
    return run(*options);
}
