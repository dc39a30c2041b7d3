#include "apps/render/planned.h"

#include <chrono>
#include <fmt/core.h>

#include "apps/cli/outputs.h"
#include "apps/options/scene_view.h"
#include "apps/render/cached_reference.h"
#include "apps/render/stats.h"
#include "core/base/hash.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "raster/reference/scene_key.h"

namespace burnish {
namespace {

PlanSubject subject_of(const RenderOptions& options, const FrameDesc& desc, const Session& session)
{
    FrameDesc unplanned = desc;
    unplanned.by_material.clear();
    std::string others =
        fmt::format("{} {} {} {}", desc.msaa, desc.texture_anisotropy, options.environment.cube_size, options.environment.samples);
    for (const ParameterInfo& p : parameters()) { // the reference's key leaves some out
        const glm::dvec2 value = parameter_of(desc, p);
        others += fmt::format(" {} {}", value.x, value.y);
    }
    const std::uint64_t key = reference_key(session.parts().input(), session.drawn(unplanned), options.reference);
    return {session.parts().scene->name,
            session.parts().environment->name,
            camera_options(desc.view, session.scene(), session.tables()),
            desc.width,
            desc.height,
            hash_text(hash_bytes(others.data(), others.size(), key))};
}

PlanBudget budget_of(const RenderOptions& options)
{
    return {options.budget, options.budget_p99, options.budget_ms};
}

// Plans with the tile renderer, whatever the frame is drawn with.
Result<Plan> plan_by_tiles(const RenderOptions& options, const FrameDesc& desc, Session& session)
{
    const PlanBudget budget = budget_of(options);
    const PlanFixed fixed = {options.fixes_technique ? desc.technique : "", options.fixed_samples, options.fixes_area_lights};
    if (options.backend == "tile")
        return make_plan(session, desc, budget, fixed);
    SessionOptions by_tiles;
    by_tiles.isa = options.isa;
    Result<Session> tiles = Session::make(session.parts(), by_tiles);
    BN_TRY(tiles);
    return make_plan(*tiles, desc, budget, fixed);
}

} // namespace

Result<std::optional<Plan>> plan_frame(const RenderOptions& options, FrameDesc& desc, Session& session, Report& report)
{
    if (!options.plan_file.empty()) {
        const Result<PlannedFrame> read =
            read_plan(options.plan_file, subject_of(options, desc, session), session.scene().materials.size());
        BN_TRY(read);
        read->put(desc);
        if (const Status ok = check_desc(desc); !ok)
            return Error{ExitCode::bad_input, options.plan_file,
                         ok.error().field.starts_with("FrameDesc::by_material") ? "/materials" : "/area_lights", ok.error().line()};
        return std::optional<Plan>();
    }
    if (!options.plans())
        return std::optional<Plan>();
    const TraceSpan span("plan");
    const auto begin = std::chrono::steady_clock::now();
    Result<Plan> plan = plan_by_tiles(options, desc, session);
    if (!plan && plan.error().code == ExitCode::usage)
        return usage_error(plan.error().field.empty() ? options.first_budget() : plan.error().field, plan.error().reason);
    BN_TRY(plan);
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    if (options.fixes_technique || options.fixed_samples)
        report.event("budget", options.fixes_technique ? fmt::format("chooses samples of {} alone", desc.technique)
                                                       : fmt::format("chooses techniques with {} samples alone", options.fixed_samples));
    for (const std::string& line : plan_lines(*plan, budget_of(options)))
        report.event("budget", line);
    if (plan->cpu_ms && *plan->cpu_ms > *options.budget_ms) {
        report.release();
        return Error{ExitCode::differ, "", "--budget-ms",
                     fmt::format("{:.4g} ms cannot be met: the plan above takes about {:.1f} ms of processor time here", *options.budget_ms,
                                 *plan->cpu_ms)};
    }
    if (plan->aside.empty())
        report.detail("probe", fmt::format("{}x{}, {:.1f} ms", plan->probe_width, plan->probe_height, ms));
    const PlanSubject subject = subject_of(options, desc, session); // of the frame without its plan
    if (plan->aside.empty())
        plan->frame().put(desc);
    if (!options.plan_out.empty() && !plan->aside.empty())
        report.warning("--plan-out: there is no plan to write");
    else if (!options.plan_out.empty()) {
        BN_TRY(write_text(options.plan_out, plan_json(*plan, subject)));
        report.wrote(options.plan_out);
    }
    return std::optional<Plan>(std::move(*plan));
}

void note_plan(const RenderOptions& options, const FrameDesc& desc, const std::optional<Plan>& plan, RenderFigures& figures)
{
    figures.planned = !desc.by_material.empty();
    if (figures.planned && !options.fixes_area_lights)
        figures.area_lights = AreaLightsSetting{desc.area_way, static_cast<int>(desc.light_samples)};
    if (plan && plan->aside.empty())
        figures.plan = PlanFigures{options.budget, options.budget_p99, options.budget_ms,  plan->error,
                                   plan->p99,      plan->cost,         plan->default_cost, plan->cpu_ms};
}

Status verify_plan(const RenderOptions& options, const FrameDesc& desc, const Session& session, const Image& color,
                   const std::optional<Plan>& plan, Report& report)
{
    const TraceSpan span("verify");
    FrameDesc whole = desc;
    whole.by_material.clear(), whole.triangle_ids = whole.parts = whole.layers = false;
    ReferenceOptions reference_options;
    reference_options.quiet = options.quiet;
    const Result<Frame> reference =
        cached_reference(session, whole, reference_options, options.isa, {options.environment.use_cache, ""}, report);
    BN_TRY(reference);
    const Jobs& jobs = *session.parts().jobs;
    const ErrorSummary errors = summarise_errors(flip_hdr(reference->color, color, {}, jobs).error);
    std::string text = fmt::format("mean HDR-FLIP {:.4f}, p99 {:.4f}, against {} samples of the reference", errors.mean, errors.p99,
                                   reference->stats.sampling.samples);
    if (plan && plan->aside.empty())
        text += fmt::format("; predicted {:.4f}{}", plan->error, plan->p99 ? fmt::format(", p99 {:.4f}", *plan->p99) : "");
    report.figure("verified", text);
    return {};
}

} // namespace burnish
