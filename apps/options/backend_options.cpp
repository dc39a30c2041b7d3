// Options of `--backend reference` and `--backend vulkan`.
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "core/image/io/image_io.h"
#include "raster/reference/sobol.h"

namespace burnish {

Status check_reference_options(const RenderArguments& in, const OptionTable& given, RenderOptions& out)
{
    if (!reference_available())
        return Error{ExitCode::unavailable, "", "--backend", "this program was built without Embree 3, which 'reference' needs"};
    ReferenceOptions& r = out.reference;
    if (given.given("--bounces") && r.mode != ReferenceMode::path)
        return usage_error("--bounces", "needs --reference-mode path");
    if (in.samples)
        r.samples = static_cast<std::uint64_t>(*in.samples);
    const std::uint64_t whole = (r.samples + kPassSamples - 1) / kPassSamples * kPassSamples;
    if (whole != r.samples && in.samples)
        out.warnings.push_back(fmt::format("--samples {}: the reference takes {}, in passes of {}", r.samples, whole, kPassSamples));
    r.samples = whole;
    if (given.given("--checkpoint-seconds") && r.checkpoint.empty())
        return usage_error("--checkpoint-seconds", "needs --checkpoint");
    if (r.checkpoint == "-")
        return usage_error("--checkpoint", "must be a file: it is read, too");
    if (!out.variance_file.empty() && !stores_floats(out.variance_file))
        return usage_error("--variance", "must be .exr, .hdr or .pfm: the numbers are no colours");
    if (!out.variance_file.empty() && r.samples < 2 * kPassSamples)
        return usage_error("--variance", fmt::format("needs --samples of at least {}", 2 * kPassSamples));
    if (out.frames != 1)
        return usage_error("--frames", "the reference renders one");
    r.isa = out.isa;
    r.quiet = out.quiet;
    return {};
}

Status check_vulkan_options(RenderOptions& out)
{
    if (!vulkan_built())
        return Error{ExitCode::unavailable, "", "--backend", "this program was built without Vulkan, which 'vulkan' needs"};
    out.vulkan.use_cache = out.environment.use_cache;
    if (out.vulkan.sampler == VulkanSampler::native && out.vulkan.pipeline == VulkanPipeline::ids)
        return usage_error("--sampler", "native needs --pipeline forward");
    if (out.vulkan.pipeline != VulkanPipeline::ids && (!out.aov.empty() || out.resolve != Resolve::linear || out.show != Shown::light))
        return usage_error(!out.aov.empty() ? "--aov" : out.resolve != Resolve::linear ? "--resolve" : "--show", "needs --pipeline ids");
    return {};
}

} // namespace burnish
