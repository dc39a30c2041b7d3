#include "apps/options/options.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_stream.h"
#include "core/scene/builtin/builtin.h"
#include "raster/frame/layers.h"
#include "raster/tile/twins.h"
#include "shading/bake/mip/levels.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

Status check_camera(const RenderOptions& out)
{
    for (const auto& [given, name] : {std::pair{out.eye.has_value(), "--eye"}, {out.orbit_deg.has_value(), "--orbit"}})
        if (given && !out.camera.empty())
            return usage_error(name, "cannot be combined with --camera");
    if (out.eye && out.orbit_deg)
        return usage_error("--orbit", "cannot be combined with --eye");
    if (out.eye && out.target && *out.eye == *out.target)
        return usage_error("--target", "is the same point as --eye");
    return {};
}

constexpr int kBandRows = 256, kRowsAtOnce = 16; // default rows of a band; rows that compressors of .exr take at once

// Returns true for pictures that no frame holds.
bool needs_bands(const FrameDesc& frame)
{
    return frame.width > kMaxPictureSide || frame.height > kMaxPictureSide ||
           std::int64_t{frame.width} * frame.height * frame.msaa > kMaxPictureSamples;
}

std::size_t layer_channels(const std::string& name)
{
    for (const LayerInfo& layer : layers())
        if (layer.name == name)
            return layer.channels.size();
    return 0;
}

// Returns the bytes that a row of the picture takes in a band: floats with alpha and layers, and 8 bits with alpha.
std::int64_t bytes_of_row(const RenderOptions& o)
{
    std::size_t channels = 4;
    for (const std::string& name : o.aov)
        channels += layer_channels(name);
    return std::int64_t{o.frame.width} * static_cast<std::int64_t>(channels * sizeof(float) + 4);
}

// Returns why a picture has no bands of so many rows, or nothing.
std::string why_not_in_bands(const RenderOptions& o, std::int64_t rows, bool large)
{
    constexpr std::int64_t kMostBytes = std::int64_t{512} << 20; // of a band; all copies of it take about three times that
    const std::int64_t width = std::min(o.frame.width, large ? kWindowCell : o.frame.width) + 2 * kWindowStep;
    if (large && (rows % kBandTile != 0 || kWindowCell % rows != 0))
        return fmt::format("of so large a picture must be 64, 128, 256, 512 and so on, up to {}", kWindowCell);
    if (rows % kRowsAtOnce != 0)
        return fmt::format("must be a multiple of {}", kRowsAtOnce);
    if (const std::int64_t most = kMaxPictureSamples / (width * o.frame.msaa) - 2 * kWindowStep; rows > most)
        return fmt::format("{} rows with --msaa {} are too many samples for one frame: at most {} rows", rows, o.frame.msaa, most);
    if (const std::int64_t most = kMostBytes / bytes_of_row(o); rows > std::max<std::int64_t>(most, kRowsAtOnce))
        return fmt::format("{} rows take {} MiB: at most {} rows", rows, rows * bytes_of_row(o) >> 20, most);
    return "";
}

// Draws the picture in bands: makes the frame the first window. large: the picture needs bands.
Status choose_bands(const RenderArguments& in, const OptionTable& given, bool large, RenderOptions& out)
{
    if (out.backend != "tile")
        return no_bands_error(in, "is for --backend tile alone");
    for (const char* other :
         {"--risks", "--budget", "--budget-p99", "--budget-ms", "--plan", "--plan-out", "--verify", "--count-operations"})
        if (given.given(other))
            return no_bands_error(in, fmt::format("cannot be combined with {}", other));
    if (out.frames > 1 || out.show != Shown::light)
        return no_bands_error(in, fmt::format("cannot be combined with {}", out.frames > 1 ? "--frames" : "--show"));
    if (out.floor == FloorChoice::mirror)
        return no_bands_error(in, "cannot be combined with --floor mirror");
    for (const std::string& path : out.outputs)
        if (!writes_rows(path))
            return no_bands_error(in, fmt::format("cannot be written to {}: .exr and .png are written by rows", path));
    // Find the rows
    std::int64_t rows = in.band_rows.value_or(kBandRows);
    while (!in.band_rows && rows > kBandTile && !why_not_in_bands(out, rows, large).empty())
        rows /= 2;
    if (const std::string fault = why_not_in_bands(out, rows, large); !fault.empty())
        return no_bands_error(in, (in.band_rows ? "" : "its bands: ") + fault);
    out.band_rows = static_cast<int>(rows);
    FrameDesc& frame = out.frame;
    frame.window = {frame.width, frame.height, 0, 0};
    frame.width = std::min(frame.width, large ? kWindowCell : frame.width), frame.height = std::min(frame.height, out.band_rows);
    if (given.given("--anisotropy"))
        frame.override_anisotropy = true;
    return {};
}

Status check_picture(const RenderArguments& in, const OptionTable& given, RenderOptions& out)
{
    FrameDesc& frame = out.frame;
    frame.width = in.size.width, frame.height = in.size.height;
    const int most = in.may_have_bands && out.backend == "tile" ? kMaxWindowedSide : kMaxPictureSide;
    for (const int side : {frame.width, frame.height})
        if (side < 1 || side > most)
            return usage_error("--size", fmt::format("each side must be from 1 to {} pixels, got {}x{}", most, frame.width, frame.height));
    if (const bool large = needs_bands(frame); in.band_rows || (large && most == kMaxWindowedSide))
        return choose_bands(in, given, large, out);
    const std::int64_t samples = std::int64_t{frame.width} * frame.height * frame.msaa;
    if (samples > kMaxPictureSamples)
        return usage_error("--size", fmt::format("{}x{} with --msaa {} is {} samples, more than {}", frame.width, frame.height, frame.msaa,
                                                 samples, kMaxPictureSamples));
    if (given.given("--anisotropy"))
        frame.override_anisotropy = true;
    return {};
}

Status check_layers(const RenderOptions& out)
{
    for (auto name = out.aov.begin(); name != out.aov.end(); ++name)
        if (std::find(out.aov.begin(), name, *name) != name)
            return usage_error("--aov", fmt::format("'{}' is given twice", *name));
    if (!out.aov.empty() && std::none_of(out.outputs.begin(), out.outputs.end(), stores_channels))
        return usage_error("--aov", "needs -o FILE.exr: no other format has layers");
    if (!out.aov.empty() && out.backend == "reference")
        return usage_error("--aov", "the reference has no layers");
    if (out.show != Shown::light && out.backend == "reference")
        return usage_error("--show", "the reference has no layers");
    for (const std::string& path : out.outputs)
        if (out.show != Shown::light && (stores_floats(path) || path.ends_with(".apng")))
            return usage_error("--show", fmt::format("'{}': false colours are of 8 bits: .png, .tif or .jpg; floats are --aov's", path));
    if (!out.risks.empty() && out.backend == "reference")
        return usage_error("--risks", "the reference has none");
    if (!out.risks.empty() && out.risks != "-" && stores_floats(out.risks))
        return usage_error("--risks", fmt::format("'{}': marks are colours of 8 bits: .png, .tif or .jpg", out.risks));
    return {};
}

Status check_shadows(const OptionTable& given, const RenderOptions& out)
{
    if (out.shadows == Shadows::off)
        return given.given("--shadow-samples") ? Status(usage_error("--shadow-samples", "needs --shadows ratio or on")) : Status();
    if (out.backend == "reference")
        return usage_error("--shadows", "the reference has its own: --reference-mode shadowed");
    if (out.backend == "vulkan" && out.vulkan.pipeline != VulkanPipeline::ids)
        return usage_error("--shadows", "needs --pipeline ids");
    return {};
}

Status check_floor(const RenderOptions& out)
{
    const bool mirror = out.floor == FloorChoice::mirror;
    if (mirror && out.backend == "reference" && out.reference.mode != ReferenceMode::path)
        return usage_error("--floor", "mirror: the reference reflects it with --reference-mode path alone");
    if ((mirror || out.floor == FloorChoice::shadow) && out.backend == "vulkan" && out.vulkan.pipeline != VulkanPipeline::ids)
        return usage_error("--floor", "needs --pipeline ids");
    return {};
}

Status check_technique(const RenderArguments& in, RenderOptions& out)
{
    FrameDesc& frame = out.frame;
    const TechniqueInfo& technique = *find_technique(frame.technique);
    std::int64_t samples = technique.default_samples;
    if (in.samples && out.backend != "reference") // whose samples are of a pixel
        samples = *in.samples;
    const bool planned = out.plans() && &technique == &automatic_technique(); // then the plan judges the samples
    if (planned && in.samples) {
        out.fixed_samples = static_cast<int>(std::min(samples, std::int64_t{65536}));
        return {};
    }
    if (samples > technique.most_samples)
        return usage_error("--samples", fmt::format("{} takes 1 to {}, got {}", frame.technique, technique.most_samples, samples));
    BN_TRY(check_lobe(frame, *find_technique(out.backend == "reference" ? "mc" : frame.technique)));
    frame.samples = effective_samples(technique, static_cast<int>(samples));
    if (frame.samples != samples)
        out.warnings.push_back(fmt::format("--samples {}: {} takes {}", samples, frame.technique, frame.samples));
    return {};
}

Status check_budget(const OptionTable& given, RenderOptions& out)
{
    for (const auto& [option, error] : {std::pair{"--budget", out.budget}, {"--budget-p99", out.budget_p99}})
        if (error && !(*error > 0.0))
            return usage_error(option, "0: no technique is exact; mc comes near with many samples");
    const bool planned = out.plans();
    if (planned && out.frame.brdf != FrameDesc().brdf)
        return usage_error("--brdf", "budgets are for the default model");
    if (planned && !out.plan_file.empty())
        return usage_error("--plan", "cannot be combined with a budget");
    if (out.budget_ms && out.backend == "vulkan")
        return usage_error("--budget-ms", "only the tile renderer's time is known");
    for (const char* option : {"--budget", "--budget-p99", "--budget-ms", "--plan"})
        if (given.given(option) && out.backend == "reference")
            return usage_error(option, "the reference has no technique");
    for (const char* option : {"--technique", "--samples"})
        if (!out.plan_file.empty() && given.given(option))
            return usage_error(option, "cannot be combined with --plan");
    if (!planned && !out.plan_out.empty())
        return usage_error("--plan-out", "needs --budget");
    if (!planned && out.plan_file.empty() && out.verify)
        return usage_error("--verify", "needs --budget or --plan");
    if (out.verify && (out.shadows != Shadows::off || out.floor == FloorChoice::mirror))
        return usage_error("--verify", "the reference has neither --shadows nor --floor mirror");
    if (!out.risks.empty() && (planned || !out.plan_file.empty()))
        return usage_error("--risks", "marks the limits of one technique, and a plan has several");
    out.fixes_technique = given.given("--technique") && out.frame.technique != automatic_technique().name;
    if (out.fixes_technique && given.given("--samples"))
        out.fixed_samples = out.frame.samples;
    out.fixes_area_lights = given.given("--area-lights") || given.given("--light-samples");
    if (planned && out.fixes_technique && out.fixed_samples)
        return usage_error(out.first_budget(), "leaves nothing to choose beside --technique and --samples");
    return {};
}

} // namespace

bool changes_pictures(const Option& option, bool names)
{
    const ValueKind kind = option.value.kind;
    const bool taken = kind == ValueKind::integer || kind == ValueKind::number || kind == ValueKind::vector ||
                       (names && kind == ValueKind::name && option.name != "--technique");
    return taken && option.name != "--floor" &&
           (option.group == "Environment" || option.group == "Picture" || option.group == "Materials" ||
            option.group == "Parameters of techniques" || option.name == "--exposure");
}

bool changes_scene(const Option& option)
{
    return option.group == "Materials" || option.name == "--time" || option.name == "--animation" || option.name == "--variant";
}

// Returns true if the diffuse part falls to 0 at grazing angles. A stage's backdrop is shaded as if it lay flat.
static bool darkens_backdrops(const RenderOptions& options)
{
    return options.frame.diffuse_model != 0; // Ashikhmin and Shirley
}

FloorSettings floor_of(const RenderOptions& options)
{
    FloorSettings floor;
    floor.threads = options.threads;
    floor.shaded = options.backend != "reference" || options.reference.mode == ReferenceMode::direct;
    switch (options.floor) {
    case FloorChoice::off:
        break;
    case FloorChoice::shadow:
        floor.kind = FloorKind::shadow;
        break;
    case FloorChoice::stage:
        floor.kind = FloorKind::stage;
        break;
    case FloorChoice::mirror:
        floor.kind = FloorKind::mirror;
        break;
    case FloorChoice::automatic: {
        const bool shown = options.frame.background && options.scene.starts_with("builtin:");
        if (shown && builtin_is_staged(options.scene.substr(8)))
            floor.kind = darkens_backdrops(options) ? FloorKind::shadow : FloorKind::stage;
        break;
    }
    }
    return floor;
}

bool needs_parts(const RenderOptions& options)
{
    const bool displayed =
        std::any_of(options.outputs.begin(), options.outputs.end(), [](const std::string& path) { return !stores_floats(path); });
    return displayed && options.resolve != Resolve::linear && options.backend != "reference";
}

Error no_bands_error(const RenderArguments& arguments, const std::string& reason)
{
    if (arguments.band_rows)
        return usage_error("--band-rows", reason);
    return usage_error("--size", fmt::format("of {}x{} is drawn in bands, and {}", arguments.size.width, arguments.size.height, reason));
}

Result<RenderOptions> check_render_options(const RenderArguments& arguments, const OptionTable& given)
{
    RenderOptions out = arguments.plain;
    BN_TRY(check_picture(arguments, given, out));
    if (out.lights.size() > static_cast<std::size_t>(out.limits.area_lights))
        return usage_error("--light",
                           fmt::format("{} are given, more than {} (--limit-lights)", out.lights.size(), out.limits.area_lights));
    BN_TRY(check_technique(arguments, out));
    const bool keeps_samples = out.backend != "reference" && (out.backend != "vulkan" || out.vulkan.pipeline == VulkanPipeline::ids);
    if (!given.given("--resolve") && !keeps_samples)
        out.resolve = Resolve::linear;
    out.mips.brdf = out.frame.brdf, out.mips.use_cache = out.environment.use_cache;
    out.mips.threads = out.threads;
    out.mips.box_asked = given.given("--mip-filter") && out.mips.filter == kMipFilter_box;
    const Result<Isa> isa = choose_isa(given, out.isa);
    BN_TRY(isa);
    out.isa = *isa;
    if (out.backend == "reference")
        BN_TRY(check_reference_options(arguments, given, out));
    if (out.backend == "vulkan")
        BN_TRY(check_vulkan_options(out));
    if (out.counts_operations && !has_counting_lanes())
        return Error{ExitCode::unavailable, "", "--count-operations", "this program was built without -DBN_COUNTING_LANES=ON"};
    BN_TRY(check_layers(out));
    BN_TRY(check_shadows(given, out));
    BN_TRY(check_floor(out));
    BN_TRY(check_budget(given, out));
    BN_TRY(check_camera(out));
    warn_of_no_effect(given, out);
    if (darkens_backdrops(out) && (out.floor == FloorChoice::stage || out.floor == FloorChoice::mirror))
        out.warnings.push_back("--diffuse ashikhmin-shirley turns the backdrop of the stage dark; --floor shadow has no backdrop");
    out.environment.quiet = out.quiet;
    out.env_given = given.given("--env");
    return out;
}

} // namespace burnish
