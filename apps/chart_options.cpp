#include "apps/command.h"
#include "apps/chart_options.h"

#include <algorithm>
#include <fmt/format.h>

#include "apps/option_reader.h"
#include "raster/reference/reference_renderer.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(REPORT_DIR gets report.html (one page, needs nothing else), report.json, the charts as .svg and .png, the pictures, and rows.json: what has
been measured, from which a stopped chart goes on. References are kept beside the cache of environments. With the defaults a scene under one
environment takes minutes on two cores.

Examples:
  burnish chart -o report
  burnish chart lamp.glb --env workshop.hdr --env builtin:sky --size 1280x720 -o report
  burnish chart --techniques bent_normal,major_axis --sweep samples=2,4,8,16,32 -o report
  burnish chart --sweep samples=16 --sweep roughness=0.1,0.3,0.5,0.7 --sweep anisotropy=-0.9,-0.5,0,0.5,0.9 -o report)";

constexpr const char* kUsualSize = "1920x1080";
constexpr int kUsualErrorWidth = 480; // pixels: a reference of thousands of samples a pixel in a minute or two on two cores

void add_what(CLI::App& app, ChartArguments& to)
{
    app.add_option("SCENE", to.scenes, "A .gltf or .glb file, or builtin:NAME; may be several (builtin:spheres)");
    app.add_option("--env", to.envs, "Equirectangular picture or builtin:NAME; may be given several times (builtin:studio)")
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->expected(1)
        ->group("What is measured");
    app.add_option("--techniques", to.techniques, "all, or names by commas; see burnish list techniques (all)")
        ->type_name("NAMES")
        ->group("What is measured");
    app.add_option("--sweep", to.sweeps,
                   "samples=N,N,... (1,2,4,8,16,32,64), roughness=R,R,... or anisotropy=A,A,... of every material (as the scene has it)")
        ->type_name("NAME=VALUES")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->expected(1)
        ->group("What is measured");
    app.add_option("--runs", to.runs, "Timed frames of every setting, interleaved (9)")->type_name("N")->group("What is measured");
    app.add_option("--reference-samples", to.reference_samples, "Samples a pixel of the references (4096)")
        ->type_name("N")
        ->group("What is measured");
    app.add_option("-o,--output", to.folder, "Folder of the report; made where it is not there")
        ->type_name("REPORT_DIR")
        ->required()
        ->group("Output");
    app.add_flag("-q,--quiet", to.render.plain.quiet, "Print errors only")->group("Output");
    app.add_flag("-v,--verbose", to.render.plain.verbosity, "Print more")->group("Output");
}

void add_render_part(CLI::App& app, RenderArguments& to)
{
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type, const char* group) {
        app.add_option(name, text, help)->type_name(type)->group(group);
    };
    option("--size", to.size, "Width and height in pixels of the frames that are timed (1920x1080)", "WxH", "Picture");
    option("--msaa", to.msaa, "Samples a pixel of the techniques: 1, 2, 4, 8 or 16 (8)", "N", "Picture");
    option("--camera", to.plain.camera, "Camera of the scene, by index or name (the first, else framed)", "N|NAME", "Picture");
    option("--eye", to.eye, "Camera position, world space", "X,Y,Z", "Picture");
    option("--target", to.target, "What --eye looks at (the centre of the scene)", "X,Y,Z", "Picture");
    option("--fov", to.fov, "Vertical field of view of --eye (45)", "DEG", "Picture");
    option("--exposure", to.exposure, "Of the pictures to look at: multiply by 2^EV (0)", "EV", "Picture");
    app.add_flag("--no-background", to.no_background, "Black behind the scene instead of the environment")->group("Picture");
    option("--env-rotation", to.env_rotation, "Turn environments about +Y, counter-clockwise from above (0)", "DEG", "Environment");
    option("--env-size", to.env_size, "Texels along a cube edge, a power of two (512)", "N", "Environment");
    option("--env-samples", to.env_samples, "Samples a texel of the prefiltered levels (1024)", "N", "Environment");
    app.add_flag("--no-cache", to.no_cache, "No cache of environments; references are kept in REPORT_DIR")->group("Environment");
    option("-t,--threads", to.threads, "Worker threads (all cores)", "N", "Machine");
    option("--isa", to.isa, "scalar, avx2 or avx512 (the best one)", "NAME", "Machine");
}

// All scenes and environments go through the reader of `burnish render`, one pair after another.
Status check_pairs(const ChartArguments& in, ChartOptions& out)
{
    RenderArguments arguments = in.render;
    if (arguments.size.empty())
        arguments.size = kUsualSize;
    for (const std::string& scene : out.scenes)
        for (const std::string& env : out.envs) {
            arguments.plain.scene = scene;
            arguments.plain.env = env;
            const Result<RenderOptions> checked = check_render_options(arguments);
            if (!checked)
                return checked.error();
            out.base = *checked;
        }
    return {};
}

// The same view in fewer pixels: sides in one proportion, but for what rounding to whole pixels needs.
Status read_error_size(const std::string& text, ChartOptions& out)
{
    const FrameDesc& frame = out.base.frame;
    out.error_width = std::min(frame.width, kUsualErrorWidth);
    const auto height_at = [&](int width) {
        return std::max(1, static_cast<int>(static_cast<double>(frame.height) * width / frame.width + 0.5));
    };
    out.error_height = height_at(out.error_width);
    if (text.empty())
        return {};
    const Result<PictureSize> size = parse_picture_size("--error-size", text);
    if (!size)
        return size.error();
    out.error_width = size->width, out.error_height = size->height;
    if (size->width < 1 || size->width > kMaxPictureSide || size->height != height_at(size->width))
        return usage_error("--error-size", fmt::format("{} has not the shape of --size {}x{}: for instance {}x{}", text, frame.width, frame.height,
                                                       std::min(frame.width, kUsualErrorWidth), height_at(std::min(frame.width, kUsualErrorWidth))));
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

void add_chart_options(CLI::App& app, ChartArguments& arguments)
{
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    add_what(app, arguments);
    add_render_part(app, arguments.render);
    app.add_option("--error-size", arguments.error_size,
                   "Width and height in pixels of the pictures that are compared with the reference, of the shape of --size (at most 480 wide)")
        ->type_name("WxH")
        ->group("Picture");
    refuse_empty_values(app);
    app.get_option("SCENE")->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.footer(kFooter);
}

Result<ChartOptions> check_chart_options(const ChartArguments& in)
{
    ChartOptions out;
    out.scenes = in.scenes.empty() ? std::vector<std::string>{"builtin:spheres"} : in.scenes;
    out.envs = in.envs.empty() ? std::vector<std::string>{"builtin:studio"} : in.envs;
    remove_repeated(out.scenes);
    remove_repeated(out.envs);
    out.folder = in.folder;
    OptionReader reader;
    if (const Status pairs = check_pairs(in, out); !pairs)
        reader.refuse(pairs.error());
    else if (const Status read = read_error_size(in.error_size, out); !read)
        reader.refuse(read.error());
    if (const auto names = parse_techniques(in.techniques); names)
        out.techniques = *names;
    else
        reader.refuse(names.error());
    for (const std::string& sweep : in.sweeps)
        if (const Status read = parse_sweep(sweep, out.sweeps); !read)
            reader.refuse(read.error());
    reader.integer("--runs", in.runs, 1, 10000, out.runs);
    reader.integer("--reference-samples", in.reference_samples, 1, static_cast<std::int64_t>(kMaxReferenceSamples), out.reference_samples);
    if (!reader.status())
        return reader.status().error();
    if (!reference_available())
        return Error{ExitCode::unavailable, "", "", "this program was built without Embree 3, which the reference of a chart needs"};
    return out;
}

} // namespace burnish
