#include "apps/render/stats.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "apps/cli/environment_text.h"
#include "apps/options/parameters.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/scene/gltf/extensions.h"

namespace burnish {
namespace {

Json describe_plan(const PlanFigures& plan)
{
    const auto value = [](const std::optional<double>& number) { return number ? Json(*number) : Json(); };
    return {
        {"budget", value(plan.budget)},      {"budget_p99", value(plan.budget_p99)},           {"budget_ms", value(plan.budget_ms)},
        {"predicted_flip", plan.predicted},  {"predicted_p99", value(plan.predicted_p99)},     {"predicted_ms", value(plan.predicted_ms)},
        {"instructions", plan.instructions}, {"usual_instructions", plan.default_instructions}};
}

// Adds the frame's and the renderer's settings.
void add_settings(const RenderOptions& options, const RenderFigures& figures, Json& json)
{
    const FrameDesc& frame = options.frame;
    json["roughness"] = frame.roughness >= 0.0f ? Json(shortest_decimal(frame.roughness)) : Json();
    json["anisotropy"] = frame.override_anisotropy ? Json(shortest_decimal(frame.anisotropy)) : Json();
    FrameDesc drawn = frame;
    if (figures.area_lights)
        drawn.area_way = figures.area_lights->way, drawn.light_samples = static_cast<std::uint32_t>(figures.area_lights->samples);
    json.update(parameters_json(drawn));
    json["backend"] = options.backend;
    json["device"] = figures.device;
    json["isa"] = isa_name(options.isa);
    json["threads"] = figures.threads;
    json["width"] = picture_width(frame);
    json["height"] = picture_height(frame);
    if (options.band_rows)
        json["band_rows"] = options.band_rows;
    json["msaa"] = frame.msaa;
    json["tile_size"] = frame.tile_size;
    constexpr const char* kResolves[] = {"linear", "display", "weighted"};
    json["resolve"] = kResolves[static_cast<std::size_t>(options.resolve)];
    json["aov"] = options.aov;
    json["frames"] = options.frames;
}

// Replaces the technique and its samples by the reference's figures.
void add_reference(const RenderOptions& options, const SamplingStats& s, Json& json)
{
    json["technique"] = "reference";
    json["samples"] = s.samples; // taken, which a target error may make fewer
    json["reference"] = {{"mode", reference_mode_name(options)},
                         {"samples_before", s.samples_before},
                         {"relative_error", s.relative_error},
                         {"million_samples_per_second", s.million_samples_per_second},
                         {"rays", s.rays},
                         {"ray_time_fraction", s.ray_share}};
    if (options.reference.mode == ReferenceMode::path)
        json["reference"]["bounces"] = options.reference.bounces;
}

} // namespace

double median(std::vector<double> values)
{
    if (values.empty())
        return 0.0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

double percentile_95(std::vector<double> values)
{
    if (values.empty())
        return 0.0;
    std::sort(values.begin(), values.end());
    const std::size_t rank = (values.size() * 95 + 99) / 100; // the smallest rank that covers 95 %
    return values[rank - 1];
}

std::string hash_text(std::uint64_t hash)
{
    return fmt::format("{:016x}", hash);
}

std::uint64_t peak_memory_bytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

Json stats_json(const RenderOptions& options, const RenderFigures& figures)
{
    Json json;
    json["version"] = version();
    json["scene"] = options.scene;
    json["env"] = figures.env;
    json["technique"] = figures.planned ? Json() : Json(options.frame.technique);
    json["samples"] = figures.planned ? Json() : Json(options.frame.samples);
    if (figures.plan)
        json["plan"] = describe_plan(*figures.plan);
    add_settings(options, figures, json);
    if (options.backend == "reference")
        add_reference(options, figures.frame.sampling, json);
    json["ms_min"] = *std::min_element(figures.frame_ms.begin(), figures.frame_ms.end());
    json["ms_median"] = median(figures.frame_ms);
    json["ms_p95"] = percentile_95(figures.frame_ms);
    json["load_ms"] = figures.load_ms;
    json["bake_ms"] = figures.bake_ms;
    json["prepare_ms"] = figures.prepare_ms;
    json["environment_from_cache"] = figures.environment_from_cache;
    json["key_lights"] = extracted_lights_json(figures.extracted_lights);
    json["triangles"] = figures.frame.triangles;
    if (!options.band_rows) // bands overlap, so they count some twice
        json["triangles_drawn"] = figures.frame.triangles_drawn, json["visible_fragments"] = figures.frame.visible_fragments;
    if (figures.work)
        json["operations"] = figures.work->operations, json["operand_bytes"] = figures.work->bytes;
    if (!options.band_rows)
        json["background_pixels"] = figures.frame.background_pixels;
    json["pixel_hash"] = hash_text(figures.hash);
    json["nan_pixels"] = figures.nan_pixels;
    json["warnings"] = figures.warnings;
    json["ignored_extensions"] = ignored_extensions(figures.warnings);
    json["peak_memory_bytes"] = peak_memory_bytes();
    return json;
}

} // namespace burnish
