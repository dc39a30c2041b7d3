// `burnish parity`: compares the tile renderer with its Vulkan counterpart bit by bit, stage by stage.
#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/open.h"
#include "apps/cli/outputs.h"
#include "apps/options/scene_with_view.h"
#include "apps/parity/edited.h"
#include "apps/parity/options.h"
#include "apps/parity/report.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/jobs/activity.h"
#include "core/simd/cpu.h"
#include "raster/session/shadows.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(Renders with the tile renderer and with Vulkan, and compares 32-bit words of each stage: clip positions, visibility (the triangle of each
sample), depth, interpolants, material inputs, shaded colour, resolved colour and layers. Later stages are compared where visibility agrees.
On a CPU device, with the exact sampler and --pipeline ids, all words must be equal, except visibility for one sample in a million. Other
pictures must look the same (mean FLIP below 0.002): a GPU may divide inexactly. Rays through every sample must hit the device's triangle,
except within 1/64 pixel of an edge (1/8 with --pipeline forward) and where two surfaces are equally deep; triangles with cut-out alpha
are left out of this. Each pixel that differs is assigned to the first stage that differs by more than 0.001, or to rounding.

Examples:
  burnish parity
  burnish parity lamp.glb --env workshop.hdr --technique major_axis,mc --msaa 1,4 -v
  burnish parity --suite default --models models --junit parity.xml --json parity.json --html parity.html
  burnish parity --pipeline forward --sampler native --msaa 4
  burnish parity builtin:teapot --technique major_axis --glsl edited.glsl

--shadows compares the shadowed picture too: the device draws it without the lights, and rays darken both pictures.
--glsl compares an engine's copy of a technique: the device runs the file's functions, the tile renderer its own. Settings, points and fetches
stay the program's.

Exit codes: 0 as promised, 1 not as promised, 77 no such device, sample count or Vulkan. Another failure of a row ends with its own code.)";

// State shared by all places.
struct Bench {
    const ParityOptions& options;
    std::shared_ptr<const Jobs> jobs;
    std::shared_ptr<VulkanDevice> device;
    std::shared_ptr<const Environment> environment;
    Report& report;
};

// Returns the FLIP error of each pixel. Empty if the pictures are equal or hold non-finite values.
Image flip_map(const Image& reference, const Image& test, const Jobs& jobs)
{
    if (reference.bytes == test.bytes || not_finite_pixels(reference, test) > 0)
        return {};
    return flip_hdr(reference, test, {}, jobs).error;
}

ParityRow named_row(const Bench& bench, const ParityPlace& place, const ParitySet& set, const RenderOptions& options)
{
    ParityRow row;
    row.also = set.also;
    row.scene = place.scene, row.view = place.view, row.technique = options.frame.technique, row.msaa = options.frame.msaa;
    row.sampler = options.vulkan.sampler == VulkanSampler::exact ? "exact" : "native";
    row.pipeline = options.vulkan.pipeline == VulkanPipeline::ids ? "ids" : "forward";
    row.gpu = !bench.device->info().cpu;
    return row;
}

ParityRow failed_row(const Bench& bench, const ParityPlace& place, const ParitySet& set, const RenderOptions& options, const Error& error)
{
    ParityRow row = named_row(bench, place, set, options);
    row.error = error;
    return row;
}

// Returns the frame's picture with shadows.
Result<Image> shadowed(const RenderOptions& options, FrameDesc desc, Session& session, const Frame& frame)
{
    desc.stages = desc.triangle_ids = false;
    Frame lit;
    lit.color = frame.color, lit.layers = frame.layers;
    BN_TRY(add_shadows({options.shadows, options.shadow_samples, options.isa, options.quiet}, desc, session, lit));
    return std::move(lit.color);
}

Result<ParityRow> compare(const Bench& bench, ParityRow row, const RenderOptions& options, const View& view, Session& tile, Session& vulkan,
                          Session& rays)
{
    FrameDesc desc = options.frame;
    desc.view = view;
    desc.triangle_ids = true;
    desc.stages = true;
    desc.layers = options.vulkan.pipeline == VulkanPipeline::ids;
    const Result<Frame> a = tile.render(desc);
    BN_TRY(a);
    const Result<Frame> b = vulkan.render(desc);
    BN_TRY(b);
    const Result<RayCounts> judged =
        compare_with_rays(*b, desc, rays, options.vulkan.pipeline == VulkanPipeline::ids ? kOwnEdge : kDeviceEdge);
    BN_TRY(judged);
    row.rays = *judged;
    row.pixel_hash = pixel_hash(a->color);
    row.samples_emulated = b->stats.samples_emulated;
    row.counts = compare_stages(*a, *b, desc.msaa);
    if (options.shadows != Shadows::off) {
        const Result<Image> of_tile = shadowed(options, desc, tile, *a), of_device = shadowed(options, desc, vulkan, *b);
        BN_TRY(of_tile);
        BN_TRY(of_device);
        row.counts.stages.push_back(compare_colours("shadowed colour", *of_tile, *of_device, *a, *b, desc.msaa));
    }
    const Image flip = flip_map(a->color, b->color, *bench.jobs);
    row.flip_mean = flip.bytes.empty() ? row.counts.pixels_differ ? 1.0 : 0.0 : summarise_errors(flip).mean;
    row.causes = share_causes(pixel_causes(*a, *b, desc.msaa), *a, desc.msaa, flip.bytes.empty() ? nullptr : flip.f32());
    return row;
}

// Names a row by its number and settings.
std::string row_text(const ParityReport& out, const ParityRow& row)
{
    return fmt::format("row {} ({} {}, {})", out.rows.size() + 1, row.scene, row.technique,
                       counted(static_cast<std::uint64_t>(row.msaa), "sample"));
}

Status compare_place(const Bench& bench, const ParityPlace& place, const ParitySet& set, ParityReport& out)
{
    // Load the scene and the tables
    RenderOptions base = set.frames.front();
    if (place.eye)
        base.eye = place.eye, base.target = place.target;
    const Result<SceneWithView> scene = load_scene_with_view(place.scene, base, bench.report, *bench.jobs);
    BN_TRY(scene);
    SessionOptions of_tile, of_device;
    of_tile.isa = base.isa;
    of_device.backend = Backend::vulkan, of_device.device = bench.device;
    SessionParts parts{scene->data, bench.environment, bench.jobs, {}};
    if (!base.ltc_table.empty()) {
        Result<std::shared_ptr<const ltc::ShadingTables>> table = load_ltc_table(base.ltc_table, base.frame.brdf);
        BN_TRY(table);
        parts.ltc = std::move(*table);
    }
    if (!base.as_tables.empty()) {
        Result<std::shared_ptr<const PhongFiles>> tables = load_phong_tables(base.as_tables, base.limits);
        BN_TRY(tables);
        parts.phong = std::move(*tables);
    }
    // Make both renderers, and the rays that judge them
    Result<Session> tile = Session::make(parts, of_tile), vulkan = Session::make(parts, of_device);
    Result<Session> rays = ray_session(parts, base.isa);
    BN_TRY(tile);
    BN_TRY(vulkan);
    BN_TRY(rays);
    // Compare every frame
    for (const RenderOptions& options : set.frames) {
        const Activity activity(row_text(out, named_row(bench, place, set, options)));
        Result<ParityRow> compared = compare(bench, named_row(bench, place, set, options), options, scene->view, *tile, *vulkan, *rays);
        const ParityRow row = compared ? std::move(*compared) : failed_row(bench, place, set, options, compared.error());
        if (row.failed())
            bench.report.event("failed", describe(row));
        else if (first_difference(row.counts))
            bench.report.event("differs", describe(row));
        else
            bench.report.detail("equal", describe(row));
        out.rows.push_back(row);
    }
    return {};
}

Status write_files(const ParityOptions& options, const ParityReport& parity, Report& report)
{
    const struct {
        const std::string& path;
        std::string (*text)(const ParityReport&);
    } files[] = {{options.json, parity_json}, {options.csv, parity_csv}, {options.junit, parity_junit}, {options.html, parity_html}};
    for (const auto& file : files) {
        if (file.path.empty())
            continue;
        BN_TRY(write_text(file.path, file.text(parity)));
        if (file.path != "-")
            report.detail("wrote", file.path);
    }
    return {};
}

int verdict(const ParityReport& parity, Report& report)
{
    report.figures(stage_table(parity));
    report.event("device", fmt::format("{}; {}; Vulkan {}; {}", parity.device, parity.driver, parity.api, parity.processor));
    std::size_t faults = 0;
    std::string first = visibility_fault(parity);
    for (const ParityRow& row : parity.rows)
        if (const std::string fault = fault_of(row); !fault.empty()) {
            ++faults;
            if (first.empty())
                first = row.scene + ", " + row.technique + ": " + fault;
        }
    if (!passed(parity))
        return fail(
            Error{outcome(parity), "", "", fmt::format("{} of {} not as promised; {}", faults, counted(parity.rows.size(), "row"), first)});
    report.event("parity", counted(parity.rows.size(), "row") + " as promised");
    return 0;
}

// Returns options for pipelines that serve all frames: a driver compiles one such pipeline faster than one for each frame.
VulkanOptions device_options(const ParityOptions& options)
{
    VulkanOptions out = options.sets.front().frames.front().vulkan;
    const std::string first = options.sets.front().frames.front().frame.technique;
    const auto another = [&](const RenderOptions& frame) { return frame.frame.technique != first; };
    if (options.sets.size() > 1 || std::any_of(options.sets.front().frames.begin(), options.sets.front().frames.end(), another))
        for (const ParitySet& set : options.sets)
            for (const RenderOptions& frame : set.frames)
                out.frames.push_back(frame.frame);
    return out;
}

int run_parity(const ParityArguments& arguments, const OptionTable& given)
{
    const Result<ParityOptions> checked = check_parity_options(arguments, given);
    if (!checked)
        return fail(checked.error());
    const ParityOptions& options = *checked;
    const RenderOptions& base = options.sets.front().frames.front();
    Report report(base.quiet, base.verbosity);
    const auto jobs = std::make_shared<const Jobs>(base.threads);
    VulkanOptions vulkan = device_options(options);
    std::unique_ptr<EditedStage> edited;
    if (!options.glsl.empty()) {
        Result<std::unique_ptr<EditedStage>> made = EditedStage::make(options.glsl, *find_technique(base.frame.technique));
        if (!made)
            return fail(made.error());
        edited = std::move(*made), vulkan.shader_folder = edited->folder();
    }
    const Result<std::shared_ptr<VulkanDevice>> device = open_vulkan_device(vulkan);
    if (!device)
        return fail(device.error());
    const Result<std::shared_ptr<const Environment>> environment = open_environment(base.env, base.environment, base.limits, *jobs);
    if (!environment)
        return fail(environment.error());
    for (const std::string& warning : (*environment)->warnings)
        report.warning(warning);
    report.promise_stdout({options.json, options.csv, options.junit, options.html});
    const Bench bench{options, jobs, *device, *environment, report};
    report.release();
    const VulkanDeviceInfo& info = (*device)->info();
    ParityReport parity{info.driver, info.name, info.api, cpu_name(), version(), base.frame.width, base.frame.height, {}};
    for (const ParityPlace& place : options.places)
        for (const ParitySet& set : options.sets)
            if (const Status done = compare_place(bench, place, set, parity); !done) { // no row of it can be compared
                report.event("failed", line_of(done.error()));
                for (const RenderOptions& frame : set.frames)
                    parity.rows.push_back(failed_row(bench, place, set, frame, done.error()));
            }
    if (const Status written = write_files(options, parity, report); !written)
        return fail(written.error());
    return verdict(parity, report);
}

} // namespace

Command parity_command()
{
    auto arguments = std::make_shared<ParityArguments>();
    return {"parity", "Compare the Vulkan renderer with the tile renderer, bit by bit", parity_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_parity(*arguments, given); }};
}

} // namespace burnish
