// `burnish plot`: draws lobes and the samples that techniques take.
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/lab/plot/ellipsoid.h"
#include "apps/lab/plot/plot.h"
#include "apps/options/parameters.h"
#include "apps/report/chart_style.h"
#include "apps/report/svg.h"
#include "core/image/io/image_io.h"
#include "core/jobs/activity.h"
#include "raster/frame/frame.h"
#include "shading/bake/ltc/shipped.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(axis: a GGX lobe's densities of slopes, microfacet normals and reflected directions, with the ellipse of k deviations. It shows the points
nearest to the mirror direction and farthest from it, before and after clamping at the horizon, and the major axis with its samples.
lobe: any model's lobe, also tilted: visible half vectors, reflected directions and polar cuts, as BRDF times cosine without Fresnel.
side: a sphere where bent_normal and major_axis look up or down, with the places where they disagree with the lobe's mean, by anisotropy.
half-vectors: tables of an Ashikhmin-Shirley lobe's sampled half vectors and its albedo.
energy: light that an Ashikhmin-Shirley surface loses with its own diffuse part, by exponents.
ltc: transformed cosines beside a GGX lobe, the steps of their fit, and the lobes between two nodes.
ellipsoid: a page that measures the ellipsoid distribution of normals: mean normals, visible areas, samplers, and a skewed lobe against a
normal map.

Examples:
  burnish plot axis -o axis.svg
  burnish plot axis --roughness 0.7 --anisotropy 0.9 --eye 75,20 --samples 8 -o grazing.svg
  burnish plot lobe --brdf ward --eye 60,0 -o ward.svg
  burnish plot lobe --tilt 20,0 --roughness 0.4 -o tilted.svg
  burnish plot side --roughness 0.4 --anisotropy 0.8 -o side.svg
  burnish plot half-vectors --roughness 0.3 --anisotropy 0.6 -o half_vectors.svg
  burnish plot energy -o energy.svg
  burnish plot ltc --roughness 0.6 --anisotropy 0.8 --eye 70,40 -o cosines.svg
  burnish plot ellipsoid -o ellipsoid.html)";

struct PlotArguments {
    std::string what = "axis", output;
    LobePlot lobe;
    glm::vec2 eye_deg{50.0f, 30.0f};
    FrameDesc frame; // provides --brdf and --tilt
    bool quiet = false;
    int verbosity = 0;
};

OptionTable plot_option_table(PlotArguments& to)
{
    LobePlot& l = to.lobe;
    OptionTable table;
    table.add("", {{"WHAT", "", "{}", choice(to.what, {"axis", "lobe", "side", "ellipsoid", "half-vectors", "energy", "ltc"})}});
    table.add("The lobe",
              {{"--roughness", "R", "Roughness of the lobe, {}", number(l.roughness, 0.03, 1.0)},
               {"--anisotropy", "A", "Anisotropy eta of the lobe, {}: GGX widths roughness^2 (1 +- eta) along and across the tangent",
                number(l.anisotropy, -1.0, 1.0)},
               {"--eye", "DEG,DEG", "Direction to the eye: angle from the normal, and angle about it from the tangent",
                angles(to.eye_deg, -360.0, 360.0)}});
    table.add_needing("WHAT", "axis",
                      {{"--axis-k", "K", "Deviations of slope that the major axis covers, {}", number(l.k, 0.01, 10.0)},
                       {"--axis-beta", "B", "Overlap of samples on the major axis, {}", number(l.beta, 0.0, 100.0)},
                       {"--samples", "N", "Samples on the major axis, {}", integer(l.samples, 1, 64)}});
    table.add_needing("WHAT", "side",
                      {{"--rotation", "DEG", "Angle between the stretched highlight's direction and the sphere's parallels, {} degrees",
                        number(l.rotation_deg, -180.0, 180.0)}});
    std::vector<Option> models;
    for (Option& option : parameter_options(to.frame))
        if (option.name == "--brdf" || option.name == "--tilt")
            models.push_back(option);
    table.add_needing("WHAT", "lobe", models);
    table.add("Output", {Option("-o,--output", "FILE", "Figure to write: .svg, for ellipsoid .html", file(to.output)).must_be_given(),
                         quiet_option(to.quiet), verbose_option(to.verbosity)});
    return table;
}

int write(const PlotArguments& arguments, const std::string& bytes)
{
    if (Status written = write_file(arguments.output, bytes); !written)
        return fail(written.error());
    Report report(arguments.quiet, arguments.verbosity);
    report.release();
    report.wrote(arguments.output);
    return 0;
}

int run_plot(const PlotArguments& arguments, const OptionTable& given)
{
    const bool page = arguments.what == "ellipsoid";
    for (const char* option : {"--eye", "--roughness", "--anisotropy"})
        if (page && given.given(option))
            return fail(usage_error(option, "is no part of WHAT ellipsoid, which has lobes of its own"));
    if (arguments.what == "side" && given.given("--eye"))
        return fail(usage_error("--eye", "is no part of WHAT side, which is seen from afar"));
    for (const char* option : {"--eye", "--roughness", "--anisotropy"})
        if (arguments.what == "energy" && given.given(option))
            return fail(usage_error(option, "is no part of WHAT energy, which shows all of them"));
    if (arguments.what == "half-vectors" && given.given("--eye"))
        return fail(usage_error("--eye", "is no part of WHAT half-vectors, which are seen from above"));
    LobePlot lobe = arguments.lobe;
    lobe.theta_deg = static_cast<double>(arguments.eye_deg.x), lobe.phi_deg = static_cast<double>(arguments.eye_deg.y);
    if (!(lobe.theta_deg >= 0.0 && lobe.theta_deg < 90.0))
        return fail(usage_error("--eye", fmt::format("the first angle must be from 0 to below 90 degrees, got {:g}", lobe.theta_deg)));
    const std::string extension = std::filesystem::path(arguments.output).extension().string();
    if (extension != (page ? ".html" : ".svg"))
        return fail(usage_error("-o", fmt::format("'{}' must end in {}", arguments.output,
                                                  page ? ".html; all others are .svg" : ".svg; only ellipsoid is a .html")));
    if (Status path = check_text_path("-o", arguments.output, {}); !path)
        return fail(path.error());
    if (Status checked = check_lobe(arguments.frame, *find_technique("mc")); !checked)
        return fail(checked.error());
    lobe.model = lobe_of(arguments.frame, arguments.frame.tilt_rad != glm::vec2(0.0f));
    lobe.tilt_x_deg = static_cast<double>(glm::degrees(arguments.frame.tilt_rad.x));
    lobe.tilt_y_deg = static_cast<double>(glm::degrees(arguments.frame.tilt_rad.y));
    const Activity activity("drawing " + arguments.what);
    if (page)
        return write(arguments, ellipsoid_page());
    const Drawing drawing = arguments.what == "axis"     ? plot_axis(lobe)
                            : arguments.what == "lobe"   ? plot_lobe(lobe)
                            : arguments.what == "side"   ? plot_side(lobe)
                            : arguments.what == "energy" ? plot_energy()
                            : arguments.what == "ltc"    ? plot_ltc(lobe, ltc::shipped_table(), arguments.quiet)
                                                         : plot_half_vectors(lobe);
    return write(arguments, svg_of(drawing, chart_style()));
}

} // namespace

Command plot_command()
{
    auto arguments = std::make_shared<PlotArguments>();
    return {"plot", "Draw lobes, and the places where a technique samples them", plot_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_plot(*arguments, given); }};
}

} // namespace burnish
