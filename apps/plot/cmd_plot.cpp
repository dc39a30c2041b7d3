// `burnish plot`: figures of lobes and of where techniques sample them.
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/plot/plot.h"
#include "apps/report/looks.h"
#include "apps/report/png.h"
#include "apps/report/svg.h"
#include "core/image/io/image_io.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(axis: densities of slopes, of microfacet normals and of reflected directions of a GGX lobe, with the ellipse of k
deviations, the points closest to the mirror direction and farthest from it, the major axis and its samples.

Examples:
  burnish plot axis -o axis.svg
  burnish plot axis --roughness 0.7 --anisotropy 0.9 --eye 75,20 --samples 8 -o grazing.png)";

struct PlotArguments {
    std::string what = "axis", output;
    LobePlot lobe;
    glm::vec2 eye_deg{50.0f, 30.0f};
    bool quiet = false;
    int verbosity = 0;
};

OptionTable plot_option_table(PlotArguments& to)
{
    LobePlot& l = to.lobe;
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(to.what, {"axis"})}});
    table.add("The lobe", {{"--roughness", "R", "alpha_lin, {}", number(l.roughness, 0.03, 1.0)},
                           {"--anisotropy", "A", "eta, {}: alpha_lin^2 (1 +- eta) along and across", number(l.anisotropy, -1.0, 1.0)},
                           {"--eye", "DEG,DEG", "Where it is seen from: off the normal, and about it from the grain",
                            angles(to.eye_deg, -360.0, 360.0)},
                           {"--axis-k", "K", "Deviations of slope that the axis covers, {}", number(l.k, 0.01, 10.0)},
                           {"--axis-beta", "B", "Overlap of samples, {}", number(l.beta, 0.0, 100.0)},
                           {"--samples", "N", "On the axis, {}", integer(l.samples, 1, 64)}});
    table.add("Output", {Option("-o,--output", "FILE", "A .svg or a .png", file(to.output)).must_be_given(), quiet_option(to.quiet),
                         verbose_option(to.verbosity)});
    return table;
}

int run_plot(const PlotArguments& arguments)
{
    LobePlot lobe = arguments.lobe;
    lobe.theta_deg = static_cast<double>(arguments.eye_deg.x), lobe.phi_deg = static_cast<double>(arguments.eye_deg.y);
    if (!(lobe.theta_deg >= 0.0 && lobe.theta_deg < 90.0))
        return fail(usage_error("--eye", fmt::format("the first angle must be from 0 to below 90 degrees, got {:g}", lobe.theta_deg)));
    const std::string extension = std::filesystem::path(arguments.output).extension().string();
    if (extension != ".svg" && extension != ".png")
        return fail(usage_error("-o", fmt::format("'{}' must end in .svg or .png", arguments.output)));
    if (Status path = check_text_path("-o", arguments.output, {}); !path)
        return fail(path.error());
    const Drawing drawing = plot_axis(lobe);
    std::string bytes;
    if (extension == ".svg") {
        bytes = svg_of(drawing, chart_style());
    } else {
        Result<std::string> png = png_of(drawing);
        if (!png)
            return fail(png.error());
        bytes = std::move(*png);
    }
    if (Status written = write_file(arguments.output, bytes); !written)
        return fail(written.error());
    Report report(arguments.quiet, arguments.verbosity);
    report.release();
    report.wrote(arguments.output);
    return 0;
}

} // namespace

Command plot_command()
{
    auto arguments = std::make_shared<PlotArguments>();
    return {"plot", "Draw where a technique samples a lobe", plot_option_table(*arguments), kFooter,
            [arguments](OptionTable&) { return run_plot(*arguments); }};
}

} // namespace burnish
