#include "apps/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/plan/cost.h"
#include "apps/plan/pareto.h"
#include "core/base/clock.h"

namespace burnish {
namespace {

constexpr int kLeastSide = 160; // pixels; a probe of a smaller frame costs more than it saves

std::string name_of(const Scene& scene, std::size_t material)
{
    const std::string& name = scene.materials[material].name;
    return name.empty() ? fmt::format("material {}", material) : name;
}

std::string setting_text(const MaterialTechnique& m)
{
    return find_technique(m.technique)->sampling == Sampling::none ? m.technique
                                                                   : fmt::format("{} with {} samples", m.technique, m.samples);
}

// Returns the settings that the user's technique and samples leave.
std::vector<MaterialTechnique> allowed(const std::string& technique, int samples)
{
    std::vector<MaterialTechnique> list;
    for (const MaterialTechnique& s : plannable_settings())
        if ((technique.empty() || s.technique == technique) && (samples == 0 || s.samples == samples || s.samples == 1))
            list.push_back(s);
    const bool none = std::none_of(list.begin(), list.end(), [&](const MaterialTechnique& s) { return s.samples == samples; });
    return samples != 0 && none ? std::vector<MaterialTechnique>() : list;
}

// Returns a material's settings as parts of the picture's error and cost.
std::vector<PlanPoint> points_of(const ProbedMaterial& m, double pixels)
{
    std::vector<PlanPoint> points;
    for (std::size_t i = 0; i < m.settings.size(); ++i)
        points.push_back({m.settings[i].cost * m.share * pixels, m.settings[i].error * m.share, i});
    return points;
}

// Returns a material's settings as parts of the picture's cost, and of the pixels with an error above a bound.
std::vector<PlanPoint> tail_points_of(const Probe& probe, std::size_t material, double pixels, double bound)
{
    std::vector<PlanPoint> points = points_of(probe.materials[material], pixels);
    for (PlanPoint& point : points) {
        std::size_t above = 0;
        for (std::size_t p = 0; p < probe.pixels.material.size(); ++p)
            above +=
                probe.pixels.material[p] == static_cast<int>(material) && static_cast<double>(probe.pixels.error[point.setting][p]) > bound;
        point.error = static_cast<double>(above) / static_cast<double>(probe.pixels.material.size());
    }
    return points;
}

// Returns the 99th percentile of the picture's predicted errors. settings: of each material, by index in its list.
double tail_of(const Probe& probe, const std::vector<std::size_t>& settings)
{
    std::vector<float> errors(probe.pixels.material.size(), 0.0f);
    for (std::size_t p = 0; p < errors.size(); ++p)
        if (probe.pixels.material[p] >= 0)
            errors[p] = probe.pixels.error[settings[static_cast<std::size_t>(probe.pixels.material[p])]][p];
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(errors.size()))) - 1;
    std::nth_element(errors.begin(), at, errors.end());
    return static_cast<double>(*at);
}

// The fronts that a plan chooses from, and its choices.
struct Choice {
    std::vector<std::vector<PlanPoint>> fronts; // of each seen material; errors: parts of the mean, or of the pixels above a bound
    std::vector<std::size_t> at;
};

// Chooses again so that at most 1 % of the pixels have an error above a bound. Where the mean has a budget too, settings with a larger mean
// error than the material's choice are out. So the mean stays within its budget.
Choice within_tail(const Probe& probe, const std::vector<std::size_t>& seen, const Choice& mean, double pixels, const PlanBudget& budget)
{
    Choice tail;
    for (std::size_t h = 0; h < seen.size(); ++h) {
        const ProbedMaterial& m = probe.materials[seen[h]];
        const double most = m.settings[mean.fronts[h][mean.at[h]].setting].error;
        std::vector<PlanPoint> points = tail_points_of(probe, seen[h], pixels, *budget.p99 / kTailSafety);
        if (budget.error)
            points.erase(
                std::remove_if(points.begin(), points.end(), [&](const PlanPoint& p) { return m.settings[p.setting].error > most; }),
                points.end());
        tail.fronts.push_back(pareto_front(std::move(points)));
    }
    tail.at = within_error(tail.fronts, 0.01);
    return tail;
}

PlanStep step_of(const ProbedMaterial& m, const PlanPoint& at)
{
    return {m.settings[at.setting].setting, m.settings[at.setting].error, at.cost};
}

// Processor time of a frame on this machine, by the cost of its shading.
struct Clock {
    double cost = 0.0, ms = 0.0; // of the cheapest plan
    double ms_per_instruction = 0.0;
    double ms_of(double of) const { return ms + ms_per_instruction * (of - cost); }
    double cost_within(double most_ms) const { return cost + (most_ms - ms) / std::max(1e-30, ms_per_instruction); }
};

// Draws the frame by the cheapest plan.
Result<Clock> measure(Session& session, const FrameDesc& desc, const Probe& probe, const std::vector<std::vector<PlanPoint>>& fronts,
                      const std::vector<std::size_t>& seen)
{
    FrameDesc cheap = desc;
    const TechniqueInfo& automatic = automatic_technique();
    cheap.by_material.assign(probe.materials.size(), {automatic.name, automatic.default_samples});
    Clock clock;
    double covered = 0.0;
    for (std::size_t h = 0; h < fronts.size(); ++h) {
        const ProbedMaterial& m = probe.materials[seen[h]];
        cheap.by_material[seen[h]] = m.settings[fronts[h].front().setting].setting;
        clock.cost += fronts[h].front().cost, covered += m.share;
    }
    const double begin = process_cpu_ms();
    const Result<Frame> frame = session.render(cheap);
    BN_TRY(frame);
    clock.ms = process_cpu_ms() - begin;
    // Pixels at edges have several fragments
    const double pixels = covered * static_cast<double>(desc.width) * desc.height;
    clock.ms_per_instruction = probe.ms_per_instruction * std::max(1.0, static_cast<double>(frame->stats.visible_fragments) / pixels);
    return clock;
}

} // namespace

std::vector<MaterialTechnique> Plan::settings() const
{
    std::vector<MaterialTechnique> list;
    for (const PlannedMaterial& m : materials)
        list.push_back(m.chosen.setting);
    return list;
}

Result<Plan> make_plan(Session& session, const FrameDesc& desc, const PlanBudget& budget, const std::string& technique, int samples)
{
    Plan plan;
    if (std::min(desc.width, desc.height) < kLeastSide) {
        plan.aside = fmt::format("a picture of {}x{} costs less than its plan", desc.width, desc.height);
        return plan;
    }
    const std::vector<MaterialTechnique> list = allowed(technique, samples);
    if (list.empty())
        return Error{ExitCode::usage, "", "", "no plan can choose this technique or these samples: their costs are not known"};
    const Result<Probe> probed = probe_frame(session, desc, list, budget.p99.has_value());
    BN_TRY(probed);
    const Probe& probe = *probed;
    plan.probe_width = probe.width, plan.probe_height = probe.height;
    // Choose from the fronts of the materials that are seen
    const double pixels = static_cast<double>(desc.width) * desc.height;
    Choice choice;
    std::vector<std::size_t> seen;
    for (std::size_t m = 0; m < probe.materials.size(); ++m)
        if (probe.materials[m].share > 0.0) {
            choice.fronts.push_back(pareto_front(points_of(probe.materials[m], pixels)));
            seen.push_back(m);
            plan.default_cost += probe.materials[m].default_cost * probe.materials[m].share * pixels;
        }
    if (choice.fronts.empty()) {
        plan.aside = "no solid surface is seen";
        return plan;
    }
    std::optional<Clock> clock;
    if (budget.cpu_ms) {
        const Result<Clock> measured = measure(session, desc, probe, choice.fronts, seen);
        BN_TRY(measured);
        clock = *measured;
    }
    if (budget.error || budget.p99) // by the percentile alone: the cheapest
        choice.at = within_error(choice.fronts, budget.error ? *budget.error / kPlanSafety : 1e9);
    else
        choice.at = within_cost(choice.fronts, clock->cost_within(*budget.cpu_ms / kTimeSafety));
    if (budget.p99)
        choice = within_tail(probe, seen, choice, pixels, budget);
    // Tell the choices, and the neighbours on the fronts
    const TechniqueInfo& automatic = automatic_technique();
    for (std::size_t m = 0; m < probe.materials.size(); ++m) // materials that are not seen stay as they are by default
        plan.materials.push_back({name_of(session.scene(), m), 0.0, {{automatic.name, automatic.default_samples}, 0.0, 0.0}, {}, {}, {}});
    double default_error = 0.0;
    std::size_t with_default = 0;
    std::vector<std::size_t> settings(probe.materials.size(), 0);
    for (std::size_t h = 0; h < seen.size(); ++h) {
        const ProbedMaterial& m = probe.materials[seen[h]];
        const std::vector<PlanPoint>& front = choice.fronts[h];
        const std::size_t at = choice.at[h];
        PlannedMaterial& to = plan.materials[seen[h]];
        to.share = m.share, to.chosen = step_of(m, front[at]);
        settings[seen[h]] = front[at].setting;
        for (const PlanPoint& p : points_of(m, pixels))
            to.all.push_back(step_of(m, p));
        if (at > 0)
            to.cheaper = step_of(m, front[at - 1]);
        if (at + 1 < front.size())
            to.better = step_of(m, front[at + 1]);
        plan.error += to.chosen.error * m.share, plan.cost += front[at].cost;
        for (std::size_t i = 0; i < m.settings.size(); ++i) // unless the user's technique or samples leave it out
            if (m.settings[i].setting.technique == technique_of(FrameDesc()).name &&
                m.settings[i].setting.samples == automatic.default_samples)
                default_error += m.settings[i].error * m.share, ++with_default;
    }
    if (with_default == seen.size())
        plan.default_error = default_error;
    if (clock)
        plan.cpu_ms = clock->ms_of(plan.cost);
    if (budget.error && !(plan.error * kPlanSafety <= *budget.error))
        return Error{ExitCode::usage, "", "",
                     fmt::format("no setting reaches {:.4g} here: the least budget is {:.4g}", *budget.error, plan.error * kPlanSafety)};
    if (budget.p99)
        plan.p99 = tail_of(probe, settings);
    if (budget.p99 && !(*plan.p99 * kTailSafety <= *budget.p99))
        return Error{ExitCode::usage, "", "",
                     fmt::format("no setting reaches {:.4g} here: the least budget is {:.4g}", *budget.p99, *plan.p99 * kTailSafety),
                     "--budget-p99"};
    return plan;
}

std::vector<std::string> plan_lines(const Plan& plan, const PlanBudget& budget)
{
    if (!plan.aside.empty())
        return {fmt::format("stands aside: {}", plan.aside)};
    std::vector<std::string> lines;
    const double of_default = std::max(1.0, plan.default_cost);
    std::string wanted = budget.error ? fmt::format("mean HDR-FLIP {:.4g}", *budget.error) : "";
    if (budget.p99)
        wanted += fmt::format("{}99th percentile of HDR-FLIP {:.4g}", wanted.empty() ? "" : ", ", *budget.p99);
    if (wanted.empty())
        wanted = fmt::format("{:g} ms", *budget.cpu_ms);
    lines.push_back(fmt::format("{}: predicted {:.4f}{}{}, shading at {:.2f} of the default's instructions{}", wanted, plan.error,
                                plan.p99 ? fmt::format(", p99 {:.4f}", *plan.p99) : "",
                                plan.cpu_ms ? fmt::format(" in {:.1f} ms of processor time", *plan.cpu_ms) : "", plan.cost / of_default,
                                plan.default_error ? fmt::format("; the default: predicted {:.4f}", *plan.default_error) : ""));
    if (!budget.error && !budget.p99)
        lines.push_back("times are those of this machine: another one may get another plan and another hash");
    for (const PlannedMaterial& m : plan.materials) {
        if (m.share == 0.0)
            continue;
        std::string line = fmt::format("{}, {:.1f} % of the picture: {}, error {:.4f}", m.name, 100.0 * m.share,
                                       setting_text(m.chosen.setting), m.chosen.error);
        const auto neighbour = [&](const char* what, const std::optional<PlanStep>& step) {
            if (step)
                line += fmt::format("; next {}: {}, {:.4f} at {:.2f} of its cost", what, setting_text(step->setting), step->error,
                                    step->cost / std::max(1.0, m.chosen.cost));
        };
        neighbour("cheaper", m.cheaper);
        neighbour("better", m.better);
        lines.push_back(line);
    }
    return lines;
}

} // namespace burnish
