// Draws small frames for valgrind to count their instructions, on one thread with AVX2. Draws each workload once before
// counting, so that memory has grown and its pages exist. Then counts one frame and writes its figures to a separate
// file. See count.py.
//
// Arguments select workloads: NAME, NAME@WIDTHxHEIGHT for another size (mix.py), TECHNIQUE:SAMPLES:ALPHA_LIN:ETA for
// the inside of a brushed sphere (lobe_line.py), or area-lights:WAY:SAMPLES:QUADS for bent_normal in that sphere under
// quads (plan_costs.py). --steps counts without valgrind, on AVX-512 and smaller frames.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <gnu/libc-version.h>
#include <optional>
#include <string_view>

#include "bench/frame/subject.h"
#include "bench/instructions/step_counter.h"
#include "bench/scenes/figures.h"
#include "raster/tile/tile_renderer.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define BN_HAVE_CALLGRIND 1
#endif

namespace burnish {
namespace {

std::vector<Workload> small_workloads()
{
    using S = BenchScene;
    constexpr int W = 320, H = 180;
    std::vector<Workload> list = {
        {"constant_1x", "instructions", S::constant, 0, W, H, 1},   {"constant_8x", "instructions", S::constant, 0, W, H, 8},
        {"triangles_1x", "instructions", S::waves, 28800, W, H, 1}, {"triangles_4x", "instructions", S::waves, 28800, W, H, 4},
        {"layers_10", "instructions", S::layers, 10, W, H, 1},      {"teapot_8x", "instructions", S::teapot, 0, W, H, 8},
        {"slivers", "instructions", S::slivers, 300, W, H, 1},      {"crowd_8x", "instructions", S::crowd, 30000, W, H, 8},
        {"foliage", "instructions", S::foliage, 1000, 640, 360, 1}, {"materials_100", "instructions", S::materials, 100, W, H, 1},
        {"lights_50", "instructions", S::lit, 50, 160, 90, 1},      {"textures_1", "instructions", S::textured, 1, 160, 90, 1},
        {"textures_5", "instructions", S::textured, 5, 160, 90, 1}, {"floor_3", "instructions", S::floor, 0, 160, 90, 1},
    };
    for (const TechniqueInfo& t : techniques())
        list.push_back({t.name, "instructions", S::sphere, 0, 160, 90, 1, t.name, 0, 0.8f});
    list.push_back({"quaternion", "instructions", S::textured, 5, 160, 90, 1});
    list.back().frame_map = kFrameQuaternion;
    list.push_back({"parallax", "instructions", S::textured, 6, 160, 90, 1}); // a mean of 16 steps for each fragment
    for (int lights : {1, 4}) {                                               // the difference is the cost of three
        list.push_back({lights == 1 ? "key_lights_1" : "key_lights_4", "instructions", S::sphere, 0, 160, 90, 1, "bent_normal", 0, 0.8f});
        list.back().extracted_lights = lights;
    }
    return list;
}

// Workloads for counting step by step. Each has one tile, because a step takes thousands of cycles.
std::vector<Workload> stepped_workloads()
{
    constexpr int W = 48, H = 27;
    return {{"triangles_1x", "instructions", BenchScene::waves, 300, W, H, 1},
            {"textures_1", "instructions", BenchScene::textured, 1, W, H, 1},
            {"bent_normal", "instructions", BenchScene::sphere, 0, W, H, 1, "bent_normal", 0, 0.8f},
            {"major_axis_weighted", "instructions", BenchScene::sphere, 0, W, H, 1, "major_axis_weighted", 0, 0.8f}};
}

// Parses NAME or NAME@WIDTHxHEIGHT; nothing for other text.
std::optional<Workload> known(const char* text)
{
    const std::string_view all = text;
    for (Workload w : small_workloads()) {
        const std::string_view name = w.name;
        char end = 0;
        const bool sized = all.size() > name.size() && all[name.size()] == '@';
        if (!all.starts_with(name) || (!sized && all != name))
            continue;
        if (sized && (std::sscanf(text + name.size(), "@%dx%d%c", &w.width, &w.height, &end) != 2 || w.width < 1 || w.height < 1 ||
                      w.width > 16384 || w.height > 16384))
            return std::nullopt;
        w.name = text;
        return w;
    }
    return std::nullopt;
}

// Parses TECHNIQUE:SAMPLES:ALPHA_LIN:ETA into a workload with this text as its name; nothing for other text.
std::optional<Workload> place(const char* text)
{
    const std::string_view all = text;
    const std::string name(all.substr(0, all.find(':')));
    const TechniqueInfo* technique = find_technique(name);
    Workload w = {text, "instructions", BenchScene::sphere, 0, 160, 90, 1};
    char end = 0;
    if (!technique || std::sscanf(text + name.size(), ":%d:%f:%f%c", &w.samples, &w.roughness, &w.eta, &end) != 3)
        return std::nullopt;
    const bool in_range = w.samples >= 1 && w.samples <= technique->most_samples && w.roughness >= 0.0f && w.roughness <= 1.0f;
    if (!in_range || std::abs(w.eta) > 1.0f || w.eta == 0.0f)
        return std::nullopt;
    w.technique = technique->name;
    return w;
}

// Parses area-lights:WAY:SAMPLES:QUADS into a workload with this text as its name; nothing for other text.
std::optional<Workload> area_lights_place(const char* text)
{
    constexpr std::string_view kBegin = "area-lights:";
    const std::string_view all = text;
    const std::size_t colon = all.starts_with(kBegin) ? all.find(':', kBegin.size()) : std::string_view::npos;
    if (colon == std::string_view::npos)
        return std::nullopt;
    const std::string_view name = all.substr(kBegin.size(), colon - kBegin.size());
    const auto way = std::find_if(area_ways().begin(), area_ways().end(), [&](const AreaWayInfo& a) { return name == a.name; });
    Workload w = {text, "instructions", BenchScene::sphere, 0, 160, 90, 1, "bent_normal", 0, 0.8f};
    char end = 0;
    if (way == area_ways().end() || std::sscanf(text + colon, ":%d:%d%c", &w.light_samples, &w.quads, &end) != 2)
        return std::nullopt;
    if (w.light_samples < 1 || w.light_samples > 65536 || w.quads < 0 || w.quads > 64)
        return std::nullopt;
    w.area_way = way->name;
    return w;
}

// Calls `counted` with each workload and its frame. Draws the frame once before, so that memory has grown and its pages
// exist. Returns an exit code, 0 for success.
int each_frame(const std::vector<Workload>& list, Isa isa, const std::function<int(const Workload&, const std::function<void()>&)>& counted)
{
    if (!isa_available(isa)) {
        fmt::print(stderr, "bench_instructions: no {} here\n", isa_name(isa));
        return static_cast<int>(ExitCode::unavailable);
    }
    SubjectOptions options;
    options.isa = isa, options.threads = 1, options.coarse_environment = true;
    for (const Workload& w : list) {
        Result<std::unique_ptr<Subject>> subject = make_subject(w, options);
        if (!subject) {
            fmt::print(stderr, "bench_instructions: {}\n", subject.error().line());
            return static_cast<int>(subject.error().code);
        }
        (*subject)->frame();
        if (const int code = counted(w, [&] { (*subject)->frame(); }); code != 0)
            return code;
    }
    return 0;
}

// Prints {"NAME": instructions of one frame, ...}, counted on AVX-512 and this thread.
int run_steps(const std::vector<Workload>& list)
{
    nlohmann::ordered_json counts;
    const int code = each_frame(list, Isa::avx512, [&](const Workload& w, const std::function<void()>& frame) {
        const uint64_t steps = count_steps(frame);
        if (steps == 0) {
            fmt::print(stderr, "bench_instructions: this system does not trap after each instruction\n");
            return static_cast<int>(ExitCode::unavailable);
        }
        counts[w.name] = steps;
        return 0;
    });
    if (code == 0)
        fmt::print("{}\n", counts.dump());
    return code;
}

#ifdef BN_HAVE_CALLGRIND
int run(const std::vector<Workload>& list)
{
    if (!RUNNING_ON_VALGRIND) {
        fmt::print(stderr, "bench_instructions: counts nothing without valgrind; see bench/instructions/count.py\n");
        return static_cast<int>(ExitCode::usage);
    }
    return each_frame(list, Isa::avx2, [](const Workload& w, const std::function<void()>& frame) {
        CALLGRIND_START_INSTRUMENTATION;
        CALLGRIND_ZERO_STATS;
        frame();
        CALLGRIND_DUMP_STATS_AT(w.name);
        CALLGRIND_STOP_INSTRUMENTATION;
        return 0;
    });
}
#else
int run(const std::vector<Workload>&)
{
    fmt::print(stderr, "bench_instructions: built without valgrind's headers\n");
    return static_cast<int>(ExitCode::unavailable);
}
#endif

} // namespace
} // namespace burnish

int main(int argc, char** argv)
{
    using namespace burnish;
    if (argc == 1)
        return run(small_workloads());
    const bool steps = std::string_view(argv[1]) == "--steps";
    if (steps && argc == 2)
        return run_steps(stepped_workloads());
    if (argc > 2 || std::string_view(argv[1]) != "--made-with") {
        std::vector<Workload> list;
        for (int i = steps ? 2 : 1; i < argc; ++i) {
            std::optional<Workload> w = known(argv[i]);
            if (!w)
                w = place(argv[i]);
            if (!w)
                w = area_lights_place(argv[i]);
            if (!w) {
                fmt::print(
                    stderr,
                    "usage: bench_instructions [--made-with | [--steps] NAME[@WIDTHxHEIGHT]... | TECHNIQUE:SAMPLES:ALPHA_LIN:ETA... | "
                    "area-lights:WAY:SAMPLES:QUADS...] "
                    "(ETA is not 0)\n");
                return static_cast<int>(ExitCode::usage);
            }
            list.push_back(*w);
        }
        return steps ? run_steps(list) : run(list);
    }
    nlohmann::ordered_json made = machine_json(); // inputs that change instruction counts
    made = {{"compiler", made["compiler"]}, {"build_type", made["build_type"]}, {"libc", gnu_get_libc_version()}};
    fmt::print("{}\n", made.dump());
    return 0;
}
