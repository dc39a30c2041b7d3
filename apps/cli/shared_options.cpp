#include "apps/cli/shared_options.h"

#include <cstdlib>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/values.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxThreads = 1024;

std::vector<std::string> isa_names()
{
    std::vector<std::string> names;
    for (const Isa isa : program_isas())
        names.emplace_back(isa_name(isa));
    return names;
}

} // namespace

Option quiet_option(bool& to)
{
    return {"-q,--quiet", "", "Print errors only", flag(to)};
}

Option verbose_option(int& to, const char* help)
{
    return {"-v,--verbose", "", help, count(to)};
}

Option threads_option(int& to, const char* help)
{
    return {"-t,--threads", "N", help, integer(to, 1, kMaxThreads), "all cores"};
}

Option isa_option(Isa& to, const char* help)
{
    return {"--isa", "NAME", help, choice(to, isa_names()), "the best one"};
}

std::vector<Option> limit_options(Limits& to)
{
    constexpr std::int64_t kMaxInt = 1 << 30, kMaxDepth = 10000;
    return {
        {"--limit-image-side", "PIXELS", "Width and height of an input picture", integer(to.image_side, 1, kMaxInt)},
        {"--limit-texture-bytes", "BYTES", "Size of the scene's decoded textures", bytes(to.texture_bytes)},
        {"--limit-json-depth", "N", "Nesting depth of JSON", integer(to.json_depth, 1, kMaxDepth)},
        {"--limit-node-depth", "N", "Depth of the scene graph", integer(to.node_depth, 1, kMaxDepth)},
        {"--limit-file-bytes", "BYTES", "Size of one input file", bytes(to.file_bytes)},
        {"--limit-accessor-bytes", "BYTES", "Size of the scene's decoded accessors", bytes(to.accessor_bytes)},
        {"--limit-data-uri-bytes", "BYTES", "Size of one data URI", bytes(to.data_uri_bytes)},
        {"--limit-draw-bytes", "BYTES", "Size of vertices and triangles with every instance expanded", bytes(to.draw_bytes)},
        {"--limit-input-bytes", "BYTES", "Size of all files of the scene", bytes(to.input_bytes)},
        {"--limit-env-pixels", "N", "Pixels in the environment", integer(to.env_pixels, 1, std::int64_t{1} << 30)},
        {"--limit-lights", "N", "Area lights in the scene", integer(to.area_lights, 0, std::int64_t{1} << 16)},
        {"--strict", "", "Refuse glTF files that break the specification or use ignored extensions", flag(to.strict)},
        {"--allow-outside-uris", "", "Read files outside the scene's folder", flag(to.uris_outside)},
    };
}

Result<Isa> choose_isa(const OptionTable& options, Isa asked)
{
    if (const char* forced = std::getenv("BN_FORCE_ISA"); forced && !parse_isa(forced))
        return usage_error("BN_FORCE_ISA", fmt::format("'{}' is not one of {}", forced, join(isa_names())));
    if (!options.given("--isa"))
        return best_isa();
    if (!isa_available(asked))
        return Error{ExitCode::unavailable, "", "--isa",
                     fmt::format("this machine cannot run {}, at most {}", isa_name(asked), isa_name(best_isa()))};
    return asked;
}

} // namespace burnish
