#include "apps/chart/options.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/suggest.h"
#include "apps/cli/values.h"
#include "raster/reference/reference_renderer.h"

namespace burnish {
namespace {

constexpr double kMaxCells = 10000.0;
constexpr int kDefaultErrorWidth = 480; // pixels: references with thousands of samples stay affordable

Value sweeps(Sweeps& to)
{
    Value value;
    value.repeated = true;
    value.set = [&to](const std::string&, const std::vector<std::string>& texts) -> Status {
        to = {};
        for (const std::string& text : texts)
            BN_TRY(parse_sweep(text, to));
        return {};
    };
    value.get = [] { return std::string(); };
    return value;
}

Value budgets(std::vector<double>& to)
{
    Value value;
    value.set = [&to](const std::string&, const std::vector<std::string>& texts) { return parse_budgets(texts.back(), to); };
    value.get = [] { return std::string(); };
    return value;
}

// Checks what a planned row needs.
Status check_budgets(const ChartOptions& out)
{
    if (out.budgets.empty())
        return {};
    if (any_pieces(out.pieces))
        return usage_error("--budget", "cannot be combined with pieces");
    if (out.display_flip)
        return usage_error("--budget", "holds HDR-FLIP: it cannot be combined with --metric flip");
    for (const RenderOptions& cell : out.cell_options)
        if (cell.frame.brdf != FrameDesc().brdf)
            return usage_error("--brdf", "budgets are for the default model");
    return {};
}

Status check_lobes(const FrameDesc& frame, const std::vector<std::string>& techniques)
{
    for (const std::string& technique : techniques)
        BN_TRY(check_lobe(frame, *find_technique(technique)));
    return {};
}

// Checks the options of every cell as `burnish render` does.
Status check_cells(const ChartArguments& in, const OptionTable& given, ChartOptions& out)
{
    if (const double count = cell_count(out.sweeps); count > kMaxCells) // before the cells take memory
        return usage_error("--sweep", fmt::format("{:.0f} places under each environment, more than {:.0f}", count, kMaxCells));
    out.cells = cells_of(out.sweeps);
    for (const Cell& cell : out.cells) {
        RenderArguments arguments = in.render;
        arguments.plain.frame.technique = out.techniques.front();
        OptionTable table = render_option_table(arguments);
        for (const Option& option : given.options())
            if (Option* of_render = table.find(option.name))
                of_render->given = option.given;
        const auto set = [&](const std::string& name, const std::string& value) {
            const Option* option = table.find("--" + name);
            if (!option || !changes_pictures(*option, true)) {
                std::vector<std::string> names;
                for (const Option& other : table.options())
                    if (changes_pictures(other, true))
                        names.push_back(other.name.substr(2));
                return Status(usage_error("--sweep", fmt::format("'{}' is not one of {}{}", name, join(names), did_you_mean(name, names))));
            }
            if (given.given("--" + name))
                return Status(usage_error("--" + name, "is swept"));
            out.sweeps_environments = out.sweeps_environments || option->group == "Environment";
            out.sweeps_scenes = out.sweeps_scenes || changes_scene(*option);
            return table.set(option->name, value);
        };
        if (cell.roughness)
            BN_TRY(set("roughness", fmt::format("{}", *cell.roughness)));
        if (cell.anisotropy)
            BN_TRY(set("anisotropy", fmt::format("{}", *cell.anisotropy)));
        for (const auto& [name, value] : cell.others)
            BN_TRY(set(name, value));
        const Result<RenderOptions> options = check_render_options(arguments, table);
        BN_TRY(options);
        if (options->frame.width != out.base.frame.width || options->frame.height != out.base.frame.height)
            return usage_error("--sweep", "size is one for all");
        BN_TRY(check_lobes(options->frame, out.techniques));
        out.cell_options.push_back(*options);
    }
    return {};
}

// Checks every pair of scene and environment as `burnish render` does.
Status check_pairs(const ChartArguments& in, const OptionTable& given, ChartOptions& out)
{
    RenderArguments arguments = in.render;
    for (const std::string& scene : out.scenes)
        for (const std::string& env : out.envs) {
            arguments.plain.scene = scene;
            arguments.plain.env = env;
            arguments.plain.frame.technique = out.techniques.front();
            const Result<RenderOptions> checked = check_render_options(arguments, given);
            BN_TRY(checked);
            out.base = *checked;
        }
    return check_lobes(out.base.frame, out.techniques);
}

// Checks that the compared pictures show the same view: the same aspect ratio, up to rounding to whole pixels.
Status check_error_size(const PictureSize& size, bool given, ChartOptions& out)
{
    const FrameDesc& frame = out.base.frame;
    out.error_width = std::min(frame.width, kDefaultErrorWidth);
    const auto height_at = [&](int width) {
        return std::max(1, static_cast<int>(static_cast<double>(frame.height) * width / frame.width + 0.5));
    };
    out.error_height = height_at(out.error_width);
    if (!given)
        return {};
    if (size.width < 1 || size.width > kMaxPictureSide || size.height != height_at(size.width))
        return usage_error("--error-size", fmt::format("{}x{} has not the shape of --size {}x{}: for instance {}x{}", size.width,
                                                       size.height, frame.width, frame.height, out.error_width, out.error_height));
    out.error_width = size.width, out.error_height = size.height;
    return {};
}

template <class T> void remove_repeated(std::vector<T>& values)
{
    std::vector<T> once;
    for (const T& value : values)
        if (std::find(once.begin(), once.end(), value) == once.end())
            once.push_back(value);
    values = once;
}

} // namespace

OptionTable chart_option_table(ChartArguments& to)
{
    ChartOptions& o = to.plain;
    const OptionTable of_render = render_option_table(to.render);
    OptionTable table;
    table.add("", {{"SCENE", "", "A .gltf, .glb or .obj file, or builtin:NAME; may be several", scenes(o.scenes)}});
    table.add(
        "Measurements",
        {{"--env", "FILE", "Equirectangular picture or builtin:NAME; may be given several times", environments(o.envs)},
         {"--techniques", "NAMES", "all, or names by commas; see burnish list techniques", techniques_value(o.techniques)},
         {"--sweep", "NAME=VALUES",
          "Values to chart: samples=N,N,... (1,2,4,8,16,32,64), roughness=R,R,..., anisotropy=A,A,... or any option of pictures; may be "
          "several",
          sweeps(o.sweeps), "as the scene has it"},
         {"--budget", "E,E,...", "Also chart frames by plans for these mean HDR-FLIP errors: see burnish render --budget",
          budgets(o.budgets), ""},
         {"--metric", "NAME", "Measure of errors: {}; flip judges 8-bit pictures after --exposure and the tone curve",
          choice(o.display_flip, {"flip-hdr", "flip"})},
         {"--reference-textures", "NAME", "Texture reads of references: full (at each ray's hit) or footprint (filtered as in techniques)",
          choice(to.render.plain.reference.full_textures, {"footprint", "full"})},
         {"--runs", "N", "Timed frames for every setting, interleaved; 0: errors alone", integer(o.runs, 0, 10000)},
         {"--reference-samples", "N", "Samples a pixel of the references",
          integer(o.reference_samples, 1, static_cast<std::int64_t>(kMaxReferenceSamples))}});
    table.add("Mip filters",
              {{"--mip", "", "Measure mip filters instead of frames: each filter, level by level, on materials made in code", flag(o.mip)},
               {"--maps", "FOLDER", "With --mip: folder of more materials, each a folder with normal, roughness and metallic maps",
                folder(o.maps), ""},
               {"--per-set", "N", "With --mip: materials from each set at most", integer(o.per_set, 1, 1000), "all"},
               {"--two-lobes", "",
                "With --mip: measure only metals with two crossed brushing directions, and also two lobes a texel, found by search",
                flag(o.two_lobes)}});
    table.add("Output",
              {Option("-o,--output", "REPORT_DIR", "Folder for the report, created if missing", folder(o.folder)).must_be_given(),
               {"--live", "", "Put the renderer into the page, which then draws each row anew: see burnish export page", flag(o.live)},
               {"--renderer", "FOLDER", "With --live: folder of the npm package, with burnish_core.wasm", folder(o.renderer),
                "beside the program"},
               quiet_option(to.render.plain.quiet),
               verbose_option(to.render.plain.verbosity)});
    table.add("Pieces, for several processes", piece_options(o.pieces));
    table.take(of_render, "Picture",
               {{"--size", "Width and height of timed frames in pixels"},
                {"--msaa", "Samples a pixel for techniques: {}"},
                "--camera",
                "--eye",
                "--target",
                "--orbit",
                "--fov",
                "--zoom",
                "--time",
                "--animation",
                "--light",
                {"--exposure", "Exposure of displayed pictures in stops: multiplies radiance by 2^EV"},
                "--no-background"});
    table.add("Picture",
              {{"--error-size", "WxH", "Width and height in pixels of pictures compared with the reference, in the proportions of --size",
                picture_size(to.error_size), "at most 480 wide"}});
    table.take_all(of_render, "Materials");
    table.take_all(of_render, "Parameters of techniques");
    table.take(of_render, "Environment",
               {{"--env-rotation", "Rotation of environments about +Y in degrees, counter-clockwise seen from above"},
                "--env-size",
                "--key-lights",
                "--env-samples",
                {"--no-cache", "Use no cache of environments; references stay in REPORT_DIR"}});
    table.take(of_render, "Machine", {"--threads", {"--isa", "Instruction set: {}"}});
    return table;
}

Result<ChartOptions> check_chart_options(const ChartArguments& in, const OptionTable& given)
{
    ChartOptions out = in.plain;
    remove_repeated(out.scenes);
    remove_repeated(out.envs);
    BN_TRY(check_pairs(in, given, out));
    BN_TRY(check_cells(in, given, out));
    BN_TRY(check_budgets(out));
    BN_TRY(check_error_size(in.error_size, given.given("--error-size"), out));
    if (!reference_available())
        return Error{ExitCode::unavailable, "", "", "this program was built without Embree 3, which the reference of a chart needs"};
    return out;
}

} // namespace burnish
