// Measurements that need separate processes: memory, and the time from start to a written image.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/frame/run.h"
#include "core/base/result.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Runs a program and returns its standard output. Returns an Error for a nonzero exit code.
Result<std::string> output_of(const std::vector<std::string>& command)
{
    int ends[2];
    const auto failed = [&](const char* why) { return Error{ExitCode::internal, command[0], "", why}; };
    if (pipe(ends) != 0)
        return failed("no pipe for its output");
    const pid_t child = fork();
    if (child < 0)
        return failed("cannot be started");
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]), close(ends[1]);
        std::vector<char*> arguments;
        for (const std::string& word : command)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    close(ends[1]);
    std::string text;
    std::array<char, 4096> buffer;
    for (ssize_t n; (n = read(ends[0], buffer.data(), buffer.size())) > 0;)
        text.append(buffer.data(), static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return failed("did not end with 0");
    return text;
}

struct Memory {
    double triangles, before, peak; // bytes: scene, tables and renderer; peak during the frame
};

Row information(const char* group, std::string what, const char* unit, double value, std::string note)
{
    return {group, std::move(what), unit, std::nullopt, false, {value, value, value}, std::move(note)};
}

} // namespace

int print_memory_of(std::int64_t triangles, const SubjectOptions& options)
{
    const Workload w = {"memory", "memory", BenchScene::waves, triangles};
    Result<std::unique_ptr<Subject>> subject = make_subject(w, options);
    if (!subject)
        return static_cast<int>(subject.error().code);
    const std::uint64_t before = resident_bytes();
    if (!reset_peak_memory())
        return static_cast<int>(ExitCode::unavailable);
    (*subject)->frame();
    std::printf("%.0f %llu %llu\n", (*subject)->units(), static_cast<unsigned long long>(before),
                static_cast<unsigned long long>(peak_resident_bytes()));
    return 0;
}

Result<std::vector<Row>> memory_rows(const RunOptions& options)
{
    // Measure each triangle count in a child process
    std::vector<Memory> found;
    for (const std::int64_t triangles : {10000, 100000, 1000000, 10000000}) {
        if (options.quick && triangles > 1000000)
            continue;
        const Result<std::string> text = output_of({options.self, "--memory-of", std::to_string(triangles), "--threads",
                                                    std::to_string(options.subject.threads), "--isa", isa_name(options.subject.isa)});
        BN_TRY(text);
        Memory m{};
        if (std::sscanf(text->c_str(), "%lf %lf %lf", &m.triangles, &m.before, &m.peak) != 3)
            return Error{ExitCode::internal, options.self, "", "says nothing about its memory"};
        found.push_back(m);
    }
    // Report peak memory, and bytes for each further triangle
    std::vector<Row> rows;
    double least = 1e300, growth = 0.0, bytes = 0.0;
    std::string input, frame;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Memory& m = found[i];
        rows.push_back(information("memory", fmt::format("peak memory, {:.3g} triangles, 1920x1080", m.triangles), "MB", m.peak * 1e-6,
                                   fmt::format("{:.0f} MB before the frame", m.before * 1e-6)));
        if (i == 0)
            continue;
        // Bytes for each further triangle: input, and frame (its bins).
        const Memory& p = found[i - 1];
        const double more = m.triangles - p.triangles;
        bytes = (m.peak - p.peak) / more;
        const double bins = ((m.peak - m.before) - (p.peak - p.before)) / more;
        growth = std::max(growth, bytes / least); // relative to the smallest figure for fewer triangles
        least = std::min(least, bytes);
        input += fmt::format("{}{:.0f}", input.empty() ? "" : ", ", bytes);
        frame += fmt::format("{}{:.0f}", frame.empty() ? "" : ", ", bins);
    }
    rows.push_back({"memory",
                    "bytes of a further triangle, many to fewer",
                    "x",
                    1.5,
                    false,
                    {growth, growth, growth},
                    fmt::format("{} bytes, of them in the frame {}", input, frame)});
    rows.push_back({"memory",
                    fmt::format("bytes of a further triangle, up to {:.3g}", found.back().triangles),
                    "B",
                    120.0,
                    false,
                    {bytes, bytes, bytes},
                    ""});
    return rows;
}

Result<std::vector<Row>> first_pixel_rows(const RunOptions& options)
{
    std::error_code unmade;
    const fs::path folder = fs::temp_directory_path(unmade) / fmt::format("burnish-first-pixel-{}", getpid());
    fs::create_directories(folder, unmade); // the program reports an unwritable folder
    const std::vector<std::string> command = {
        options.program, "render", "builtin:teapot", "--size", "1920x1080", "--quiet", "-o", (folder / "first.png").string()};
    std::vector<double> seconds;
    Status failed;
    for (int i = 0; i <= options.rounds && failed; ++i) { // the first run fills the cache
        const double begin = wall_ms();
        const Result<std::string> done = output_of(command);
        if (!done)
            failed = done.error();
        else if (i > 0)
            seconds.push_back((wall_ms() - begin) * 1e-3);
    }
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    BN_TRY(failed);
    return std::vector<Row>{{"first_pixel", "process start to written PNG, teapot 1920x1080 at 8x", "s", 0.4, false, spread_of(seconds),
                             "wall time, environment cached"}};
}

} // namespace burnish
