// `burnish info`: describes this build, this machine and, if given, an environment.
#include <cstdio>
#include <fmt/core.h>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/cli/command.h"
#include "apps/cli/environment_text.h"
#include "apps/cli/report.h"
#include "apps/cli/values.h"
#include "apps/options/options.h"
#include "apps/report/json.h"
#include "core/base/cache.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/jobs/jobs.h"
#include "core/simd/cpu.h"
#include "raster/reference/reference_renderer.h"
#include "raster/session/session.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
namespace {

struct Info {
    std::string compiler = BN_COMPILER, build_type = BN_BUILD_TYPE, openimageio = *BN_OPENIMAGEIO_VERSION ? BN_OPENIMAGEIO_VERSION : "none";
    std::string processor = cpu_name();
    std::string isa = isa_name(best_isa());
    std::vector<std::string> isa_available, backends = {"tile"}, vulkan_devices;
    int cores = Jobs().threads();
    std::string cache_folder = burnish::cache_folder();
    CacheUse cache = cache_use(cache_folder);
    std::uint64_t cache_limit = burnish::cache_limit();
};

Info gather()
{
    Info info;
    for (const Isa isa : program_isas())
        if (burnish::isa_available(isa))
            info.isa_available.emplace_back(isa_name(isa));
    if (vulkan_built())
        info.backends.emplace_back("vulkan");
    for (const VulkanDeviceInfo& device : vulkan_devices())
        info.vulkan_devices.push_back(fmt::format("{} ({}, Vulkan {})", device.name, device.driver, device.api));
    if (reference_available())
        info.backends.emplace_back("reference");
    return info;
}

// The requested environment with its extracted lights; null without --env.
using Seen = std::shared_ptr<const Environment>;

Result<Seen> see_environment(const RenderOptions& options, const OptionTable& given)
{
    if (!given.given("--env"))
        return Seen();
    EnvironmentOptions bake = options.environment;
    bake.quiet = true;
    return load_shared_environment(options.env, bake, options.limits, Jobs());
}

int print_json(const Info& info, const Environment* environment)
{
    Json json;
    json["version"] = version();
    json["compiler"] = info.compiler;
    json["build_type"] = info.build_type;
    json["processor"] = info.processor;
    json["cores"] = info.cores;
    json["isa"] = info.isa;
    json["isa_available"] = info.isa_available;
    json["backends"] = info.backends;
    json["vulkan_devices"] = info.vulkan_devices;
    json["openimageio"] = info.openimageio;
    json["cache"] = {
        {"folder", info.cache_folder}, {"files", info.cache.files}, {"bytes", info.cache.bytes}, {"limit_bytes", info.cache_limit}};
    if (environment)
        json["environment"] = {{"name", environment->name},
                               {"mean_radiance", environment->energy_source},
                               {"peak_radiance", shortest_decimal(environment->peak_source)},
                               {"key_lights", extracted_lights_json(turned_extracted_lights(*environment))},
                               {"warnings", environment->warnings}};
    fmt::print("{}\n", json_text(json, 2));
    return 0;
}

int print_text(const Info& info, const Environment* environment)
{
    fmt::print("version      {}\n", version());
    fmt::print("compiler     {}, {}\n", info.compiler, info.build_type);
    fmt::print("processor    {}, {} cores\n", info.processor, info.cores);
    fmt::print("isa          {} (available: {})\n", info.isa, join(info.isa_available));
    fmt::print("backends     {}\n", join(info.backends));
    for (const std::string& device : info.vulkan_devices)
        fmt::print("vulkan       {}\n", device);
    fmt::print("OpenImageIO  {}\n", info.openimageio);
    const auto mega = [](std::uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
    if (info.cache_folder.empty())
        fmt::print("cache        none: neither XDG_CACHE_HOME nor HOME is an absolute path\n");
    else
        fmt::print("cache        {}: {} files, {:.0f} MiB of at most {:.0f}\n", printable(info.cache_folder), info.cache.files,
                   mega(info.cache.bytes), mega(info.cache_limit));
    if (environment) {
        fmt::print("environment  {}: {}\n", printable(environment->name), light_text(*environment));
        for (const std::string& warning : environment->warnings)
            fmt::print("warning      {}\n", warning);
        for (const ExtractedLight& light : turned_extracted_lights(*environment))
            fmt::print("extracted light {}\n", extracted_light_text(light));
    }
    return 0;
}

int print_weights(const std::string& path, bool json)
{
    const Result<mipnet::Weights> read = mipnet::read_weights(path);
    if (!read)
        return fail(read.error());
    const mipnet::Weights& w = *read;
    const auto hidden = [](const mipnet::Hidden& h) { return fmt::format("{}x{}", h.layers, h.width); };
    const Json said = {{"brdf", mipnet::lobe_name(w.shape.lobe)},
                       {"layout", mipnet::layout_name(w.shape.layout)},
                       {"size", hidden(w.shape.a) + "/" + hidden(w.shape.b)},
                       {"footprint", w.shape.far ? 8 : 4},
                       {"numbers", w.numbers.size()},
                       {"seed", w.seed},
                       {"steps", w.steps},
                       {"families", w.families},
                       {"training_set", fmt::format("{:016x}", w.data)},
                       {"command", w.command}};
    if (json) {
        fmt::print("{}\n", json_text(said, 2));
        return 0;
    }
    fmt::print("weights      {}, {} {}{}, {} steps from seed {}\n", mipnet::lobe_name(w.shape.lobe), mipnet::layout_name(w.shape.layout),
               hidden(w.shape.a) + "/" + hidden(w.shape.b), w.shape.far ? ", 8x8 texels at once" : "", w.steps, w.seed);
    fmt::print("trained on   {}\n", printable(w.families));
    fmt::print("made by      {}\n", printable(w.command));
    return 0;
}

// Warns of given options that have no effect.
void warn_of_unread(RenderOptions options, const std::string& weights, const OptionTable& given)
{
    const std::string cause = !weights.empty() ? "with --weights" : given.given("--env") ? "" : "without --env";
    if (cause.empty())
        warn_of_baked_environment(given, options);
    else
        for (const char* option : {"--env", "--env-rotation", "--env-exposure", "--key-lights", "--no-cache"})
            if (given.given(option))
                options.warnings.push_back(fmt::format("{} has no effect {}", option, cause));
    Report report(false, 0);
    report.release();
    for (const std::string& warning : options.warnings)
        report.warning(warning);
}

int run_info(const RenderOptions& options, const std::string& weights, bool json, const OptionTable& given)
{
    warn_of_unread(options, weights, given);
    if (!weights.empty())
        return print_weights(weights, json);
    const Result<Seen> environment = see_environment(options, given);
    if (!environment)
        return fail(environment.error());
    return json ? print_json(gather(), environment->get()) : print_text(gather(), environment->get());
}

} // namespace

Command info_command()
{
    auto json = std::make_shared<bool>(false);
    auto arguments = std::make_shared<RenderArguments>();
    OptionTable table;
    auto weights = std::make_shared<std::string>();
    table.add("",
              {{"--json", "", "Print JSON", flag(*json)},
               {"--weights", "FILE", "Weights file of burnish train: describes it and its command, instead of the build", file(*weights)}});
    table.take(render_option_table(*arguments), "Environment",
               {{"--env", "Environment to describe too: an equirectangular picture or builtin:NAME", ""},
                "--env-rotation",
                "--env-exposure",
                "--key-lights",
                "--no-cache"});
    return {"info", "Describe this build and this machine", table,
            "Examples:\n  burnish info\n  burnish info --json\n  burnish info --env builtin:sky\n\nBN_FORCE_ISA=NAME in the environment "
            "caps the instruction set;"
            " BURNISH_CACHE_BYTES=500M limits the cache (2G).",
            [json, arguments, weights](OptionTable& given) { return run_info(arguments->plain, *weights, *json, given); }};
}

} // namespace burnish
