// Warnings about options that have no effect with the others.
#include <algorithm>
#include <fmt/core.h>
#include <string_view>

#include "apps/options/options.h"
#include "core/image/io/image_io.h"
#include "shading/bake/environment/environment_cache.h"
#include "shading/bake/mip/levels.h"
#include "shading/lang/records.h"

namespace burnish {

void warn_of_baked_environment(const OptionTable& given, RenderOptions& out)
{
    if (out.env.starts_with("builtin:") || !is_baked_environment(out.env))
        return;
    for (const char* option : {"--env-size", "--env-samples", "--key-lights"})
        if (given.given(option))
            out.warnings.push_back(fmt::format("{} has no effect with --env {}, whose bake has its own", option, out.env));
}

void warn_of_no_effect(const OptionTable& given, RenderOptions& out)
{
    const bool reference = out.backend == "reference";
    const TechniqueInfo& technique = *find_technique(out.frame.technique);
    const std::string of_technique = std::string("--technique ") + technique.name, of_backend = "--backend " + out.backend;
    const auto warn = [&](const std::string& option, const std::string& other) {
        if (given.given(option))
            out.warnings.push_back(fmt::format("{} has no effect with {}", option, other));
    };
    const bool planned = out.plans() || !out.plan_file.empty(); // several techniques
    for (const ParameterInfo& p : parameters())
        if (!planned && !reads(reference ? "reference" : technique.name, p))
            warn(std::string("--") + p.option, reference ? of_backend : of_technique);
    if (reference || !(technique.traits & kPhongGrid))
        warn("--as-table", reference ? of_backend : of_technique);
    else if (out.frame.as_tables != 0)
        warn("--as-table", "--as-tables off");
    if (!reference && technique.traits & kTakesRoundLobes && out.frame.anisotropy != 0.0f)
        warn("--anisotropy", of_technique);
    if (reference)
        for (const char* option : {"--technique", "--msaa", "--tile-size", "--resolve"})
            if (out.frame.background || option != std::string_view("--msaa")) // of which alpha is the share
                warn(option, of_backend);
    warn_of_baked_environment(given, out);
    if (reference && out.frame.area_way != kAreaWay_off) // off leaves the lights out of the reference too
        warn("--area-lights", of_backend);
    if (reference || out.frame.area_way != kAreaWay_mc)
        warn("--light-samples",
             reference ? of_backend : std::string("--area-lights ") + area_ways()[static_cast<std::size_t>(out.frame.area_way)].name);
    if (out.frame.area_way == kAreaWay_off && out.shadows == Shadows::ratio)
        warn("--shadows", "--area-lights off");
    if (!out.moment.seconds)
        if (given.given("--animation"))
            out.warnings.push_back("--animation has no effect without --time");
    const std::string of_filter = std::string("--mip-filter ") + mip_filters()[static_cast<std::size_t>(out.mips.filter)].name;
    if (!out.mips.pyramid.empty() && !given.given("--mip-filter")) {
        for (const char* option : {"--mip-kappa", "--mip-gain", "--mip-net", "--fallback", "--couple", "--color-kernel"})
            warn(option, "--mip-pyramid, whose file says its filter");
    } else {
        if (!takes_kappa(out.mips.filter))
            warn("--mip-kappa", of_filter);
        if (!takes_gains(out.mips.filter))
            warn("--mip-gain", of_filter);
        if (!takes_net(out.mips.filter))
            warn("--mip-net", of_filter);
        if (out.mips.filter != kMipFilter_mipnet)
            warn("--fallback", of_filter);
    }
    if (out.backend == "vulkan")
        warn("--tile-size", of_backend);
    if (out.backend != "tile")
        warn("--count-operations", of_backend);
    if (out.counts_operations && out.stats_file.empty())
        out.warnings.push_back("--count-operations has no effect without --stats");
    const bool displayed =
        std::any_of(out.outputs.begin(), out.outputs.end(), [](const std::string& path) { return !stores_floats(path); });
    if (out.frame.frame_map == kFrameOff)
        warn("--couple", "--frame-map off");
    if (out.show != Shown::light)
        for (const char* option : {"--exposure", "--tonemap", "--resolve"})
            warn(option, "--show");
    if (!out.outputs.empty() && !displayed)
        for (const char* option : {"--exposure", "--tonemap", "--resolve"})
            warn(option, "-o " + out.outputs.front());
}

} // namespace burnish
