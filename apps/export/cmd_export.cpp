// `burnish export`: writes techniques for other engines.
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/field_options.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/export/assets.h"
#include "apps/export/glsl_text.h"
#include "core/base/version.h"
#include "raster/frame/frame.h"
#include "raster/frame/grid_samples.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(glsl: one file for an engine, without includes. Given equal fetches, it computes the same bits as burnish. The file documents its arguments
and the functions that the engine provides.

Examples:
  burnish export glsl --technique major_axis -o major_axis.glsl
  burnish export glsl --technique filtered_is --samples 36 -o filtered_is.glsl)";

// Opening comment of the exported file.
constexpr const char* kHeading = R"(// {0}: {1}
// Environment light reflected by an anisotropic specular lobe, from burnish {2} (Apache License 2.0).
//
//     vec3 burnish_{0}_specular(burnish_settings f, burnish_shaded_point x)
//
// returns linear radiance. f: burnish_usual_settings(size, levels, samples) with your changes; x: burnish_point_of(...).
// You provide burnish_radiance(), below: fetches from your environment. Needs GLSL 4.20, ESSL 3.20 or later. `precise` keeps the bits equal
// to those of burnish; #define precise leaves it out for speed. --samples was {3}.
)";

struct ExportArguments {
    std::string what = "glsl", technique = "major_axis", output;
    int samples = 0; // 0: the technique's default
    bool quiet = false;
    int verbosity = 0;
};

std::vector<std::string> technique_names()
{
    std::vector<std::string> names;
    for (const TechniqueInfo& technique : techniques())
        names.push_back(technique.name);
    return names;
}

OptionTable export_option_table(ExportArguments& to)
{
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(to.what, {"glsl"})}});
    table.add("The technique",
              {Option("--technique", "NAME", "Technique to export: {}", choice(to.technique, technique_names())).must_be_given(),
               {"--samples", "N", "Samples in the file's default settings, {}", integer(to.samples, 1, 65536), "the technique's default"}});
    table.add("Output", {Option("-o,--output", "FILE", "File to write; - for standard output", file(to.output)).must_be_given(),
                         quiet_option(to.quiet), verbose_option(to.verbosity)});
    return table;
}

std::string text_of(const TechniqueInfo& technique, int samples)
{
    GlslWish wish;
    wish.roots = {std::string(technique.name) + "_specular", "usual_settings", "point_of", "dfg_fit"};
    if (technique.traits & kSharesSamples)
        wish.roots.push_back(std::string(technique.name) + "_shared");
    wish.heading = fmt::format(kHeading, technique.name, with_options(technique.summary), version(), samples);
    wish.trimmed = {{"settings", "f", "usual_settings"}, {"shaded_point", "x", "point_of"}};
    wish.grid = grid_samples(samples, technique.sampling, technique.traits);
    wish.grid_count = grid_count(wish.grid, technique.traits);
    return glsl_of(kFlatTechniques.bytes, wish);
}

int run_export(const ExportArguments& arguments)
{
    const TechniqueInfo& technique = *find_technique(arguments.technique);
    const int asked = arguments.samples > 0 ? arguments.samples : technique.default_samples;
    if (asked > technique.most_samples)
        return fail(usage_error("--samples", fmt::format("{} takes at most {}", technique.name, technique.most_samples)));
    if (Status path = check_text_path("-o", arguments.output, {}); !path)
        return fail(path.error());
    if (Status written = write_text(arguments.output, text_of(technique, effective_samples(technique, asked))); !written)
        return fail(written.error());
    Report report(arguments.quiet, arguments.verbosity);
    report.release();
    report.wrote(arguments.output);
    return 0;
}

} // namespace

Command export_command()
{
    auto arguments = std::make_shared<ExportArguments>();
    return {"export", "Write a technique as a file for other engines", export_option_table(*arguments), kFooter,
            [arguments](OptionTable&) { return run_export(*arguments); }};
}

} // namespace burnish
