#include "apps/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/plan/cost.h"
#include "apps/plan/pareto.h"
#include "apps/plan/probe_errors.h"
#include "core/base/clock.h"
#include "shading/lang/records.h"

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

std::string setting_text(const AreaLightsSetting& s)
{
    const char* const name = area_ways()[static_cast<std::size_t>(s.way)].name;
    return s.way == kAreaWay_mc ? fmt::format("{} with {} samples on each", name, s.samples) : name;
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

// Draws the frame by the cheapest plan. probe: with the cheapest method for area lights, `area`.
Result<Clock> measure(Session& session, const FrameDesc& desc, const Probe& probe, const ProbedAreaLights* area,
                      const std::vector<std::vector<PlanPoint>>& fronts, const std::vector<std::size_t>& seen)
{
    PlannedFrame cheap;
    const TechniqueInfo& automatic = automatic_technique();
    cheap.by_material.assign(probe.materials.size(), {automatic.name, automatic.default_samples});
    if (area)
        cheap.area_lights = area->setting;
    Clock clock;
    double covered = 0.0;
    for (std::size_t h = 0; h < fronts.size(); ++h) {
        const ProbedMaterial& m = probe.materials[seen[h]];
        cheap.by_material[seen[h]] = m.settings[fronts[h].front().setting].setting;
        clock.cost += fronts[h].front().cost, covered += m.share;
    }
    FrameDesc drawn = desc;
    cheap.put(drawn);
    const double begin = process_cpu_ms();
    const Result<Frame> frame = session.render(drawn);
    BN_TRY(frame);
    clock.ms = process_cpu_ms() - begin;
    // Pixels at edges have several fragments
    const double pixels = covered * static_cast<double>(desc.width) * desc.height;
    clock.ms_per_instruction = probe.ms_per_instruction * std::max(1.0, static_cast<double>(frame->stats.visible_fragments) / pixels);
    return clock;
}

// Returns the probe's settings with the errors and costs of a method for area lights.
Probe with_area_lights(const Probe& probe, const ProbedAreaLights& area)
{
    Probe with = probe;
    for (std::size_t m = 0; m < with.materials.size(); ++m)
        for (ProbedSetting& s : with.materials[m].settings)
            s.error = sum_of_errors(s.error, area.error[m]), s.cost += area.cost;
    std::vector<double> squares;
    for (const float error : area.of_pixel)
        squares.push_back(squared(static_cast<double>(error)));
    for (std::vector<float>& errors : with.pixels.error)
        for (std::size_t p = 0; p < errors.size(); ++p)
            errors[p] = static_cast<float>(flip_of(squared(static_cast<double>(errors[p])) + squares[p]));
    return with;
}

// A plan for a method for area lights, or for a frame without them.
struct Candidate {
    const ProbedAreaLights* area = nullptr;
    Probe probe; // with the method's errors and costs
    Choice choice;
    double error = 0.0, cost = 0.0; // of the picture
    std::optional<double> p99;
    bool mean_holds = true; // the mean error's budget, if there is one
    bool holds = true;      // all budgets

    const ProbedSetting& setting(std::size_t h, std::size_t material) const
    {
        return probe.materials[material].settings[choice.fronts[h][choice.at[h]].setting];
    }
};

class Planner {
  public:
    Planner(Session& session, const FrameDesc& desc, const PlanBudget& budget, const Probe& probe)
        : session_(session), desc_(desc), budget_(budget), probe_(probe), pixels_(static_cast<double>(desc.width) * desc.height)
    {
        for (std::size_t m = 0; m < probe.materials.size(); ++m)
            if (probe.materials[m].share > 0.0)
                seen_.push_back(m);
    }

    bool sees_nothing() const { return seen_.empty(); }

    Result<Plan> plan()
    {
        // Find each method's fronts, and this machine's time of the cheapest picture
        std::vector<Candidate> all(std::max<std::size_t>(1, probe_.area_lights.size()));
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].area = probe_.area_lights.empty() ? nullptr : &probe_.area_lights[i];
            all[i].probe = all[i].area ? with_area_lights(probe_, *all[i].area) : probe_;
            for (const std::size_t m : seen_)
                all[i].choice.fronts.push_back(pareto_front(points_of(all[i].probe.materials[m], pixels_)));
        }
        if (budget_.cpu_ms) {
            const Candidate& cheapest = *std::min_element(
                all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) { return a.area && a.area->cost < b.area->cost; });
            const Result<Clock> measured = measure(session_, desc_, cheapest.probe, cheapest.area, cheapest.choice.fronts, seen_);
            BN_TRY(measured);
            clock_ = *measured;
        }
        // Choose by each method, then the method
        for (Candidate& candidate : all)
            choose(candidate);
        const bool timed = !budget_.error && !budget_.p99; // the least error within a time, else the least cost within errors
        const auto before = [&](const Candidate& a, const Candidate& b) {
            if (a.holds != b.holds)
                return a.holds;
            if (a.holds != timed)
                return a.cost < b.cost;
            if (!timed && a.mean_holds != b.mean_holds)
                return a.mean_holds;
            return !timed && a.mean_holds && budget_.p99 ? a.p99 < b.p99 : a.error < b.error;
        };
        return told(*std::min_element(all.begin(), all.end(), before));
    }

  private:
    void choose(Candidate& to) const
    {
        if (budget_.error)
            to.choice.at = within_error(to.choice.fronts, *budget_.error / kPlanSafety);
        else if (budget_.p99) // the cheapest
            to.choice.at.assign(to.choice.fronts.size(), 0);
        else
            to.choice.at = within_cost(to.choice.fronts, clock_->cost_within(*budget_.cpu_ms / kTimeSafety));
        if (budget_.p99)
            to.choice = within_tail(to.probe, seen_, to.choice, pixels_, budget_);
        std::vector<std::size_t> settings(probe_.materials.size(), 0);
        for (std::size_t h = 0; h < seen_.size(); ++h) {
            settings[seen_[h]] = to.choice.fronts[h][to.choice.at[h]].setting;
            to.error += to.setting(h, seen_[h]).error * to.probe.materials[seen_[h]].share;
            to.cost += to.choice.fronts[h][to.choice.at[h]].cost;
        }
        if (budget_.p99)
            to.p99 = tail_of(to.probe, settings);
        to.mean_holds = !budget_.error || to.error * kPlanSafety <= *budget_.error;
        if (budget_.error || budget_.p99) // errors go first
            to.holds = to.mean_holds && (!budget_.p99 || *to.p99 * kTailSafety <= *budget_.p99);
        else
            to.holds = clock_->ms_of(to.cost) <= *budget_.cpu_ms / kTimeSafety;
    }

    AreaLightsStep step_of_area(const ProbedAreaLights& area) const
    {
        AreaLightsStep step = {area.setting, 0.0, 0.0};
        for (const std::size_t m : seen_)
            step.error += area.error[m] * probe_.materials[m].share, step.cost += area.cost * probe_.materials[m].share * pixels_;
        return step;
    }

    PlannedAreaLights told_area(const ProbedAreaLights& chosen) const
    {
        std::vector<PlanPoint> points;
        for (std::size_t i = 0; i < probe_.area_lights.size(); ++i) {
            const AreaLightsStep step = step_of_area(probe_.area_lights[i]);
            points.push_back({step.cost, step.error, i});
        }
        PlannedAreaLights to = {step_of_area(chosen), {}, {}};
        for (const PlanPoint& p : pareto_front(points)) {
            const AreaLightsStep step = step_of_area(probe_.area_lights[p.setting]);
            if (step.cost < to.chosen.cost)
                to.cheaper = step; // the dearest of those, since costs rise
            if (step.error < to.chosen.error && step.cost > to.chosen.cost && !to.better)
                to.better = step;
        }
        return to;
    }

    // Returns the plan with its choices and their neighbours on the fronts; an Error for a budget out of reach.
    Result<Plan> told(const Candidate& best) const
    {
        Plan plan;
        plan.probe_width = probe_.width, plan.probe_height = probe_.height;
        plan.error = best.error, plan.cost = best.cost, plan.p99 = best.p99;
        if (best.area)
            plan.area_lights = told_area(*best.area);
        const TechniqueInfo& automatic = automatic_technique();
        for (std::size_t m = 0; m < probe_.materials.size(); ++m) // materials that are not seen stay as they are by default
            plan.materials.push_back(
                {name_of(session_.scene(), m), 0.0, {{automatic.name, automatic.default_samples}, 0.0, 0.0}, {}, {}, {}});
        for (std::size_t h = 0; h < seen_.size(); ++h) {
            const ProbedMaterial& m = best.probe.materials[seen_[h]];
            const std::vector<PlanPoint>& front = best.choice.fronts[h];
            const std::size_t at = best.choice.at[h];
            PlannedMaterial& to = plan.materials[seen_[h]];
            to.share = m.share, to.chosen = step_of(m, front[at]);
            for (const PlanPoint& p : points_of(m, pixels_))
                to.all.push_back(step_of(m, p));
            if (at > 0)
                to.cheaper = step_of(m, front[at - 1]);
            if (at + 1 < front.size())
                to.better = step_of(m, front[at + 1]);
            plan.default_cost += m.default_cost * m.share * pixels_;
        }
        plan.default_error = default_error();
        if (clock_)
            plan.cpu_ms = clock_->ms_of(plan.cost);
        const auto out_of_reach = [](double budget, double least, const char* option) {
            return Error{ExitCode::usage, "", "", fmt::format("no setting reaches {:.4g} here: the least budget is {:.4g}", budget, least),
                         option};
        };
        if (budget_.error && !(plan.error * kPlanSafety <= *budget_.error))
            return out_of_reach(*budget_.error, plan.error * kPlanSafety, "");
        if (budget_.p99 && !(*plan.p99 * kTailSafety <= *budget_.p99))
            return out_of_reach(*budget_.p99, *plan.p99 * kTailSafety, "--budget-p99");
        return plan;
    }

    // Returns the predicted error of the default technique, with the default method for area lights; nothing where the user leaves them
    // out.
    std::optional<double> default_error() const
    {
        const ProbedAreaLights* area = nullptr;
        for (const ProbedAreaLights& a : probe_.area_lights)
            if (a.setting.way == FrameDesc().area_way)
                area = &a;
        if (!area && !probe_.area_lights.empty())
            return std::nullopt;
        const TechniqueInfo& automatic = automatic_technique();
        double error = 0.0;
        for (const std::size_t m : seen_) {
            const std::vector<ProbedSetting>& all = probe_.materials[m].settings;
            const auto found = std::find_if(all.begin(), all.end(), [&](const ProbedSetting& s) {
                return s.setting.technique == technique_of(FrameDesc()).name && s.setting.samples == automatic.default_samples;
            });
            if (found == all.end())
                return std::nullopt;
            error += (area ? sum_of_errors(found->error, area->error[m]) : found->error) * probe_.materials[m].share;
        }
        return error;
    }

    Session& session_;
    const FrameDesc& desc_;
    const PlanBudget& budget_;
    const Probe& probe_;
    double pixels_;                 // of the frame
    std::vector<std::size_t> seen_; // materials
    std::optional<Clock> clock_;
};

} // namespace

void PlannedFrame::put(FrameDesc& desc) const
{
    desc.by_material = by_material;
    if (area_lights)
        desc.area_way = area_lights->way, desc.light_samples = static_cast<std::uint32_t>(area_lights->samples);
}

PlannedFrame Plan::frame() const
{
    PlannedFrame frame;
    for (const PlannedMaterial& m : materials)
        frame.by_material.push_back(m.chosen.setting);
    if (area_lights)
        frame.area_lights = area_lights->chosen.setting;
    return frame;
}

Result<Plan> make_plan(Session& session, const FrameDesc& desc, const PlanBudget& budget, const PlanFixed& fixed)
{
    Plan aside;
    if (std::min(desc.width, desc.height) < kLeastSide) {
        aside.aside = fmt::format("a picture of {}x{} costs less than its plan", desc.width, desc.height);
        return aside;
    }
    const std::vector<MaterialTechnique> list = allowed(fixed.technique, fixed.samples);
    if (list.empty())
        return Error{ExitCode::usage, "", "", "no plan can choose this technique or these samples: their costs are not known"};
    const std::vector<AreaLightsSetting> area_lights =
        fixed.area_lights ? std::vector<AreaLightsSetting>{{desc.area_way, static_cast<int>(desc.light_samples)}} : plannable_area_lights();
    const Result<Probe> probe = probe_frame(session, desc, list, area_lights, budget.p99.has_value());
    BN_TRY(probe);
    Planner planner(session, desc, budget, *probe);
    if (planner.sees_nothing()) {
        aside.probe_width = probe->width, aside.probe_height = probe->height;
        aside.aside = "no solid surface is seen";
        return aside;
    }
    return planner.plan();
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
    if (plan.area_lights) {
        const AreaLightsStep& chosen = plan.area_lights->chosen;
        std::string line = fmt::format("area lights: {}, error {:.4f} over the picture", setting_text(chosen.setting), chosen.error);
        const auto neighbour = [&](const char* what, const std::optional<AreaLightsStep>& step) {
            if (step)
                line += fmt::format("; next {}: {}, {:.4f} at {:.2f} of its cost", what, setting_text(step->setting), step->error,
                                    step->cost / std::max(1.0, chosen.cost));
        };
        neighbour("cheaper", plan.area_lights->cheaper);
        neighbour("better", plan.area_lights->better);
        lines.push_back(line);
    }
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
