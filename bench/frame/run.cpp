#include "bench/frame/run.h"

#include <algorithm>
#include <fmt/format.h>

#include "core/base/result.h"

namespace burnish {
namespace {

constexpr double kRoundMs = 25.0; // a round draws short frames several times
constexpr int kMostFrames = 20;

struct Running {
    Measured measured;
    std::unique_ptr<Subject> subject;
    int frames = 1; // in a round
};

// Runs one round of one workload. The first frame is not timed, because caches and threads still belong to the previous
// workload.
void round_of(Running& r)
{
    r.subject->frame();
    const double cpu = process_cpu_ms(), wall = wall_ms();
    for (int i = 0; i < r.frames; ++i)
        r.subject->frame();
    r.measured.wall_ms.push_back((wall_ms() - wall) / r.frames);
    r.measured.cpu_ms.push_back((process_cpu_ms() - cpu) / r.frames);
}

Result<std::vector<Measured>> run_group(const std::vector<const Workload*>& group, const RunOptions& options)
{
    std::vector<Running> running;
    // Prepare the subjects that this build has
    for (const Workload* w : group) {
        Result<std::unique_ptr<Subject>> subject = make_subject(*w, options.subject);
        if (!subject && subject.error().code == ExitCode::unavailable)
            continue;
        BN_TRY(subject);
        Running& r = running.emplace_back();
        r.measured.workload = w, r.measured.load = load_average();
        r.subject = std::move(*subject);
    }
    // Choose the frames in a round from one frame's time
    for (Running& r : running) {
        r.measured.units = r.subject->units(), r.measured.what = r.subject->what();
        r.subject->frame();
        const double begin = wall_ms();
        r.subject->frame();
        r.frames = std::clamp(static_cast<int>(kRoundMs / std::max(wall_ms() - begin, 0.01)), 1, kMostFrames);
    }
    // Run the rounds in turn
    for (int i = 0; i < options.rounds; ++i)
        for (Running& r : running)
            round_of(r);
    std::vector<Measured> out;
    for (Running& r : running)
        r.measured.pixels = r.subject->pixels(), out.push_back(std::move(r.measured));
    return out;
}

std::vector<const Measured*> beginning_with(const std::vector<Measured>& all, const std::string& begin)
{
    std::vector<const Measured*> found;
    for (const Measured& m : all)
        if (std::string(m.workload->name).rfind(begin, 0) == 0)
            found.push_back(&m);
    return found;
}

const Measured* named(const std::vector<Measured>& all, const std::string& name)
{
    for (const Measured& m : all)
        if (name == m.workload->name)
            return &m;
    return nullptr;
}

// Returns the ratio round by round, so that a temporary slowdown affects both sides.
Spread ratio(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i)
        ratios.push_back(a[i] / b[i]);
    return spread_of(ratios);
}

// Returns the difference round by round, ns for each unit.
Spread more(const Measured& a, const Measured& b)
{
    std::vector<double> ns;
    for (std::size_t i = 0; i < a.cpu_ms.size(); ++i)
        ns.push_back((a.cpu_ms[i] - b.cpu_ms[i]) * 1e6 / a.units);
    return spread_of(ns);
}

// Returns the ratio between the most and the least expensive unit among workloads with different units.
Spread unit_spread(const std::vector<const Measured*>& series)
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < series[0]->cpu_ms.size(); ++i) {
        double least = 1e300, most = 0.0;
        for (const Measured* m : series) {
            const double unit = m->cpu_ms[i] / m->units;
            least = std::min(least, unit), most = std::max(most, unit);
        }
        ratios.push_back(most / least);
    }
    return spread_of(ratios);
}

std::optional<Row> row_of(const Aim& aim, const std::vector<Measured>& all)
{
    Row row{aim.group, aim.what, "x", aim.limit, at_least(aim.measure), {}, ""};
    if (aim.limit == 0.0)
        row.aim.reset();
    // Compare the units of a series of workloads
    if (aim.measure == Measure::unit_spread) {
        const auto series = beginning_with(all, aim.workload);
        if (series.size() < 2)
            return std::nullopt;
        row.value = unit_spread(series);
        for (const Measured* m : series)
            row.note +=
                fmt::format("{}{:.3g} ns at {:.3g}", row.note.empty() ? "" : ", ", spread_of(m->cpu_ms).median * 1e6 / m->units, m->units);
        return row;
    }
    const Measured* m = named(all, aim.workload);
    if (!m)
        return std::nullopt;
    // Report the workload's own time
    if (aim.measure == Measure::cpu_ms) {
        row.unit = "ms", row.value = spread_of(m->cpu_ms);
        row.note = fmt::format("wall {:.2f} ms", spread_of(m->wall_ms).median);
        return row;
    }
    // Find the workload to compare with
    const Measured* base = named(all, aim.base);
    if (aim.measure == Measure::times_faster)
        for (const Measured* other : beginning_with(all, aim.base))
            if (!base || spread_of(other->cpu_ms).median < spread_of(base->cpu_ms).median)
                base = other;
    if (!base)
        return std::nullopt;
    // Compare both workloads
    const double ms = spread_of(m->cpu_ms).median, base_ms = spread_of(base->cpu_ms).median;
    if (aim.measure == Measure::speedup) {
        row.value = ratio(base->wall_ms, m->wall_ms);
        row.note = fmt::format("CPU time {:.3f}x", ms / base_ms);
        if (base_ms <= 5.0)
            row.aim.reset(); // the aim holds above 5 ms
    } else if (aim.measure == Measure::times_faster) {
        row.value = ratio(base->cpu_ms, m->cpu_ms);
        row.note = fmt::format("{:.1f} ms against {:.1f} ms of {}, {} rays at once", ms, base_ms, base->what, base->workload->packet);
    } else if (aim.measure == Measure::cpu_more) {
        row.unit = "ns", row.value = more(*m, *base);
        row.note = fmt::format("{:.2f} ms to {:.2f} ms", ms, base_ms);
    } else {
        row.value = ratio(m->cpu_ms, base->cpu_ms);
        row.note = fmt::format("{:.2f} ms to {:.2f} ms", ms, base_ms);
    }
    return row;
}

} // namespace

bool chosen(const RunOptions& options, const std::string& group, const std::string& name)
{
    return options.only.empty() || group.find(options.only) != std::string::npos || name.find(options.only) != std::string::npos;
}

Result<std::vector<Measured>> run_workloads(const RunOptions& options, void (*say)(const std::string&))
{
    std::vector<std::string> order;
    std::map<std::string, std::vector<const Workload*>> groups;
    for (const Workload& w : workloads()) {
        if (!chosen(options, w.group, w.name) || (options.quick && w.slow) || (options.only.empty() && w.only_named))
            continue;
        if (groups[w.group].empty())
            order.push_back(w.group);
        groups[w.group].push_back(&w);
    }
    std::vector<Measured> all;
    for (const std::string& group : order) {
        say(fmt::format("{}: {} workloads in turn, {} rounds", group, groups[group].size(), options.rounds));
        Result<std::vector<Measured>> measured = run_group(groups[group], options);
        BN_TRY(measured);
        for (Measured& m : *measured)
            all.push_back(std::move(m));
    }
    return all;
}

std::vector<Row> rows_of(const std::vector<Measured>& measured)
{
    std::vector<Row> rows;
    for (const Aim& aim : aims())
        if (std::optional<Row> row = row_of(aim, measured))
            rows.push_back(std::move(*row));
    return rows;
}

double agreement_with_rays(const RunOptions& options)
{
    std::vector<std::unique_ptr<Subject>> two;
    for (const Workload& w : workloads())
        if (std::string(w.name) == "visibility_tile" || std::string(w.name) == "visibility_rays_16")
            if (Result<std::unique_ptr<Subject>> subject = make_subject(w, options.subject))
                two.push_back(std::move(*subject));
    if (two.size() != 2)
        return -1.0;
    const Column<std::uint32_t>&a = two[0]->triangle_ids(), &b = two[1]->triangle_ids();
    std::size_t same = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        same += a[i] == b[i];
    return static_cast<double>(same) / static_cast<double>(a.size());
}

} // namespace burnish
