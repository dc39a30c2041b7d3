#include "apps/profile/report.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/render/stats.h"
#include "apps/report/json.h"
#include "apps/report/svg.h"
#include "core/base/version.h"

namespace burnish {
namespace {

struct Span { // a table line, or a box of the flame graph
    std::string name;
    int phase = 0;
    double ms = 0.0; // a frame, summed over the threads
    LaneUse lanes;
    std::vector<Span> parts;
};

constexpr std::size_t kMostLines = 12; // material lines in the table
constexpr const char* kPhases[] = {"before tiles", "tiles"};
constexpr int phase_of(FrameStage stage)
{
    return stage < FrameStage::gather ? 0 : 1;
}

double per_frame(std::uint64_t ns, const ProfileFigures& f)
{
    return static_cast<double>(ns) * 1e-6 / f.frames;
}

std::vector<Span> stages_of(const ProfileFigures& f)
{
    std::vector<Span> stages;
    for (int i = 0; i < kFrameStages; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const FrameStage stage = static_cast<FrameStage>(i);
        Span s{kFrameStageNames[i], phase_of(stage), per_frame(f.sum.stage_ns[at], f), f.sum.stage_lanes[at], {}};
        for (std::size_t m = 0; stage == FrameStage::shade && m < f.sum.materials.size(); ++m)
            if (const KernelProfile& k = f.sum.materials[m]; k.lanes.all > 0)
                s.parts.push_back({f.materials[m], 1, per_frame(k.ns, f), k.lanes, {}});
        std::sort(s.parts.begin(), s.parts.end(), [](const Span& a, const Span& b) { return a.ms > b.ms; });
        stages.push_back(std::move(s));
    }
    return stages;
}

struct Balance {
    double busy_ms = 0.0, all_ms = 0.0;     // the threads' time, a frame
    double mean_ms = 0.0, slowest_ms = 0.0; // tile times
    std::size_t slowest = 0;
};

Balance balance_of(const ProfileFigures& f)
{
    Balance b;
    b.busy_ms = per_frame(std::accumulate(f.sum.busy_ns.begin(), f.sum.busy_ns.end(), std::uint64_t{0}), f);
    b.all_ms = per_frame(f.sum.wall_ns, f) * f.threads;
    const std::vector<std::uint64_t>& tiles = f.sum.tile_ns;
    b.slowest = static_cast<std::size_t>(std::max_element(tiles.begin(), tiles.end()) - tiles.begin());
    b.slowest_ms = per_frame(tiles[b.slowest], f);
    b.mean_ms = per_frame(std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0}), f) / static_cast<double>(tiles.size());
    return b;
}

double occupancy(const LaneUse& lanes)
{
    return lanes.all ? static_cast<double>(lanes.used) / static_cast<double>(lanes.all) : 0.0;
}

std::uint64_t shaded_fragments(const ProfileFigures& f)
{
    std::uint64_t n = 0;
    for (const KernelProfile& k : f.sum.materials)
        n += k.lanes.used;
    return n / static_cast<std::uint64_t>(f.frames);
}

std::string kernel_name(const RenderOptions& options, const std::string& material)
{
    return options.frame.technique + " on " + material;
}

Json lanes_json(const LaneUse& lanes, const ProfileFigures& f)
{
    if (lanes.all == 0)
        return Json();
    const auto frames = static_cast<std::uint64_t>(f.frames);
    return {{"used", lanes.used / frames}, {"all", lanes.all / frames}, {"occupancy", occupancy(lanes)}};
}

std::string table_line(const std::string& name, double ms, double busy_ms, const LaneUse& lanes)
{
    return fmt::format("{:<44} {:>10.3f} {:>7.1f} % {:>8}\n", name, ms, 100.0 * ms / busy_ms,
                       lanes.all ? fmt::format("{:.1f} %", 100.0 * occupancy(lanes)) : "");
}

} // namespace

std::string profile_table(const RenderOptions& options, const ProfileFigures& f)
{
    const FrameDesc& d = options.frame;
    const Balance b = balance_of(f);
    std::string out = fmt::format("{}, {}x{}, {} samples a pixel, {}; {}, {} threads, {} frames\n\n", options.scene, d.width, d.height,
                                  d.msaa, d.technique, f.device, f.threads, f.frames);
    out += fmt::format("{:<44} {:>10} {:>9} {:>8}\n", "stage, summed over the threads", "ms a frame", "share", "lanes");
    for (const Span& s : stages_of(f)) {
        out += table_line(s.name, s.ms, b.busy_ms, s.lanes);
        for (std::size_t i = 0; i < std::min(s.parts.size(), kMostLines); ++i)
            out += table_line("  " + kernel_name(options, s.parts[i].name), s.parts[i].ms, b.busy_ms, s.parts[i].lanes);
        if (s.parts.size() > kMostLines)
            out += fmt::format("  and {} more materials\n", s.parts.size() - kMostLines);
    }
    out += fmt::format("{:<44} {:>10.3f}\n", "all stages", b.busy_ms);
    if (!options.outputs.empty())
        out += fmt::format("{:<44} {:>10.3f}\n", "write (pictures, once)", f.write_ms);
    out += fmt::format("\nframe      {:.3f} ms; {:.3f} ms without a profile; threads busy {:.1f} % of it\n", f.profiled_ms, f.plain_ms,
                       100.0 * b.busy_ms / b.all_ms);
    const std::uint64_t shaded = shaded_fragments(f), visible = f.stats.visible_fragments;
    out += fmt::format("fragments  {} visible, {} shaded; {} pixels show the background\n", visible, shaded, f.stats.background_pixels);
    out += fmt::format("tiles      {} of {}x{} pixels, mean {:.4f} ms, slowest {:.4f} ms, {:.2f} times the mean\n", f.sum.tile_ns.size(),
                       d.tile_size, d.tile_size, b.mean_ms, b.slowest_ms, b.slowest_ms / b.mean_ms);
    out += "threads   ";
    for (const std::uint64_t ns : f.sum.busy_ns)
        out += fmt::format(" {:.3f}", per_frame(ns, f));
    return out + " ms busy a frame\n";
}

std::string profile_json(const RenderOptions& options, const ProfileFigures& f)
{
    const FrameDesc& d = options.frame;
    const Balance b = balance_of(f);
    Json json;
    json["version"] = version();
    json["scene"] = options.scene, json["env"] = options.env, json["technique"] = d.technique, json["samples"] = d.samples;
    json["device"] = f.device, json["isa"] = isa_name(options.isa), json["threads"] = f.threads;
    json["width"] = d.width, json["height"] = d.height, json["msaa"] = d.msaa, json["tile_size"] = d.tile_size;
    json["frames"] = f.frames, json["pixel_hash"] = hash_text(f.hash);
    json["ms"] = f.profiled_ms, json["ms_without_profile"] = f.plain_ms, json["write_ms"] = f.write_ms;
    json["busy_ms"] = b.busy_ms, json["waiting_ms"] = std::max(0.0, b.all_ms - b.busy_ms);
    json["stages"] = Json::array();
    json["kernels"] = Json::array();
    for (const Span& s : stages_of(f)) {
        json["stages"].push_back({{"name", s.name}, {"ms", s.ms}, {"share", s.ms / b.busy_ms}, {"lanes", lanes_json(s.lanes, f)}});
        for (const Span& part : s.parts)
            json["kernels"].push_back({{"technique", d.technique},
                                       {"material", part.name},
                                       {"ms", part.ms},
                                       {"share", part.ms / b.busy_ms},
                                       {"lanes", lanes_json(part.lanes, f)}});
    }
    json["fragments"] = {
        {"visible", f.stats.visible_fragments}, {"shaded", shaded_fragments(f)}, {"background_pixels", f.stats.background_pixels}};
    const auto columns = static_cast<std::size_t>((d.width + d.tile_size - 1) / d.tile_size);
    json["tiles"] = {{"count", f.sum.tile_ns.size()},
                     {"mean_ms", b.mean_ms},
                     {"slowest_ms", b.slowest_ms},
                     {"slowest_to_mean", b.slowest_ms / b.mean_ms},
                     {"slowest_tile", Json::array({b.slowest % columns, b.slowest / columns})}};
    json["threads_busy_ms"] = Json::array();
    for (const std::uint64_t ns : f.sum.busy_ns)
        json["threads_busy_ms"].push_back(per_frame(ns, f));
    return json_text(json, 2) + "\n";
}

namespace {

constexpr double kWidth = 1200.0, kRow = 34.0, kTop = 40.0;
constexpr double kDigit = 7.2; // approximate letter width
constexpr const char* kStyle = R"(svg.flame { background: #fff; font: 12px system-ui, "DejaVu Sans", sans-serif; }
svg.flame text { fill: #1c1c1c; }
svg.flame text.head { font-weight: 600; font-size: 14px; }
svg.flame rect { stroke: #fff; }
svg.flame .frame rect { fill: #d8d8d8; } svg.flame .waiting rect { fill: #f0f0f0; }
svg.flame .p0 rect { fill: #9cc9ec; } svg.flame .p1 rect { fill: #ffbe8a; } svg.flame .kernel rect { fill: #ffdb9c; }
@media (prefers-color-scheme: dark) {
  svg.flame { background: #161616; } svg.flame rect { stroke: #161616; } svg.flame text.head { fill: #ececec; }
})";

struct Flame {
    Drawing& out;
    double ms_to_px;

    // Draws one box, with its text if there is room. A tooltip has the full text.
    void box(double from_ms, double ms, int row, const std::string& css_class, const std::string& name, double all_ms)
    {
        const double x = from_ms * ms_to_px, width = ms * ms_to_px;
        if (width < 0.05)
            return;
        const std::string words = fmt::format("{} {:.2f} ms, {:.1f} %", name, ms, 100.0 * ms / all_ms);
        out.open(css_class, {}, words);
        out.rectangle(x, kTop + row * kRow, width, kRow, "");
        const std::string& shown = static_cast<double>(words.size()) * kDigit < width ? words : name;
        if (static_cast<double>(shown.size()) * kDigit < width)
            out.text(x + 5.0, kTop + row * kRow + 21.0, "", shown);
        out.close();
    }
};

} // namespace

std::string profile_svg(const RenderOptions& options, const ProfileFigures& f)
{
    const FrameDesc& d = options.frame;
    const Balance b = balance_of(f);
    const double all_ms = std::max(b.all_ms, b.busy_ms);
    Drawing out(kWidth, kTop + 4.0 * kRow + 10.0, "flame", "Where a frame's time goes");
    out.text(5.0, 25.0, "head",
             fmt::format("{}, {}x{}, {} samples a pixel, {}; {}, {} threads", options.scene, d.width, d.height, d.msaa, d.technique,
                         f.device, f.threads));
    Flame flame{out, kWidth / all_ms};
    flame.box(0.0, all_ms, 0, "frame", fmt::format("frame, {} threads", f.threads), all_ms);
    const std::vector<Span> stages = stages_of(f);
    double at = 0.0;
    for (int phase = 0; phase < 2; ++phase) {
        const double begin = at;
        for (const Span& s : stages) {
            if (s.phase != phase)
                continue;
            double part_at = at;
            for (const Span& part : s.parts) {
                flame.box(part_at, part.ms, 3, "kernel", kernel_name(options, part.name), all_ms);
                part_at += part.ms;
            }
            flame.box(at, s.ms, 2, fmt::format("p{}", phase), s.name, all_ms);
            at += s.ms;
        }
        flame.box(begin, at - begin, 1, fmt::format("p{}", phase), kPhases[phase], all_ms);
    }
    flame.box(at, all_ms - at, 1, "waiting", "waiting", all_ms);
    return svg_of(out, kStyle);
}

} // namespace burnish
