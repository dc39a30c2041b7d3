#include "apps/vulkan_options.h"

#include <utility>

namespace burnish {

void read_vulkan(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    if (out.backend != "vulkan") {
        const std::pair<const char*, bool> only_here[] = {{"--device", !in.device.empty()},
                                                          {"--sampler", !in.sampler.empty()},
                                                          {"--pipeline", !in.pipeline.empty()},
                                                          {"--validate", in.validate}};
        for (const auto& [option, given] : only_here)
            if (given)
                reader.refuse(usage_error(option, "needs --backend vulkan"));
        return;
    }
    if (!vulkan_built())
        return reader.refuse(Error{ExitCode::unavailable, "", "--backend", "this program was built without Vulkan, which 'vulkan' needs"});
    VulkanOptions& v = out.vulkan;
    v.device = in.device;
    v.validate = in.validate;
    v.use_cache = !in.no_cache;
    if (!in.sampler.empty() && in.sampler != "exact" && in.sampler != "native")
        reader.refuse(usage_error("--sampler", fmt::format("'{}' is not one of exact, native", in.sampler)));
    if (!in.pipeline.empty() && in.pipeline != "ids" && in.pipeline != "forward")
        reader.refuse(usage_error("--pipeline", fmt::format("'{}' is not one of ids, forward", in.pipeline)));
    v.sampler = in.sampler == "native" ? VulkanSampler::native : VulkanSampler::exact;
    v.pipeline = in.pipeline == "forward" ? VulkanPipeline::forward : VulkanPipeline::ids;
    if (v.sampler == VulkanSampler::native && v.pipeline != VulkanPipeline::forward)
        reader.refuse(usage_error("--sampler", "native needs --pipeline forward"));
}

} // namespace burnish
